#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/evaluator/figures.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

constexpr const char* kCorrected = "#1f5fa8";
constexpr const char* kOnline = "#e0a100";
constexpr double kGapS = 3.0;  // Longer gaps interrupt the line, for example while the vehicle
                               // stands.

double seconds_since(std::int64_t begin_ns, std::int64_t stamp_ns) {
  return static_cast<double>(stamp_ns - begin_ns) * 1e-9;
}

Series absolute(const char* name, const char* colour, const TrajectoryEvaluation& trajectory,
                std::int64_t begin_ns) {
  Series series{name, colour, {}, kGapS};
  const auto errors_m = metrics::absolute_errors_m(trajectory.matched, trajectory.world_from_map);
  for (std::size_t i = 0; i < errors_m.size(); ++i)
    series.points.push_back({seconds_since(begin_ns, trajectory.matched[i].stamp_ns), errors_m[i]});
  return series;
}

struct RelativeSeries {
  Series translation_m;
  Series rotation_deg;
};

RelativeSeries relative(const char* name, const char* colour,
                        const TrajectoryEvaluation& trajectory, std::int64_t begin_ns,
                        double delta_m) {
  RelativeSeries series{{name, colour, {}, kGapS}, {name, colour, {}, kGapS}};
  std::vector<geometry::Pose2> poses;
  for (const metrics::PosePair& pair : trajectory.matched) poses.push_back(pair.truth);
  for (const metrics::RelativeError& error : metrics::relative_errors(
           trajectory.matched, metrics::pairs_by_path(poses, delta_m, metrics::PathPairs::kAll))) {
    const double at_s = seconds_since(begin_ns, error.stamp_ns);
    series.translation_m.points.push_back({at_s, error.translation_m});
    series.rotation_deg.points.push_back({at_s, error.rotation_rad * 180.0 / std::numbers::pi});
  }
  return series;
}

/// Published standard deviation of the pose relative to the local map.
CaptionedPlot sigma_plot(const RunResult& result, std::int64_t begin_ns) {
  Series along{"position, worse of x and y [cm]", kCorrected, {}};
  Series heading{"heading [deg]", kOnline, {}};
  for (const metrics::UncertainStampedPose& pose : result.uncertain) {
    const geometry::Matrix3& P = pose.odom_from_base.covariance;
    const double at_s = seconds_since(begin_ns, pose.stamp_ns);
    along.points.push_back({at_s, 100.0 * std::sqrt(std::max(P(0, 0), P(1, 1)))});
    heading.points.push_back({at_s, std::sqrt(P(2, 2)) * 180.0 / std::numbers::pi});
  }
  return {"Published standard deviation of the pose relative to the local map.",
          {"time [s]", "one sigma", {along, heading}, {}, {}, 190.0}};
}

void add_true_errors(const Evaluation& evaluation, std::int64_t begin_ns,
                     std::vector<CaptionedPlot>& plots) {
  constexpr double kDeltaM = 10.0;
  const TrajectoryEvaluation& corrected = evaluation.corrected;
  const TrajectoryEvaluation& online = evaluation.online;
  plots.push_back({"Distance to the true position after rigid alignment.",
                   {"time [s]",
                    "position error [m]",
                    {absolute("as published live", kOnline, online, begin_ns),
                     absolute("after the last correction", kCorrected, corrected, begin_ns)},
                    {},
                    {}}});
  const RelativeSeries live = relative("as published live", kOnline, online, begin_ns, kDeltaM);
  const RelativeSeries best =
      relative("after the last correction", kCorrected, corrected, begin_ns, kDeltaM);
  if (best.translation_m.points.empty()) return;
  plots.push_back(
      {"Position drift over ten metres of the true path.",
       {"time [s]", "over 10 m [m]", {live.translation_m, best.translation_m}, {}, {}}});
  plots.push_back(
      {"Heading drift over ten metres of the true path.",
       {"time [s]", "over 10 m [deg]", {live.rotation_deg, best.rotation_deg}, {}, {}, 190.0}});
}

}  // namespace

std::vector<CaptionedPlot> error_plots(const ReportSource& source) {
  const std::int64_t begin_ns = source.result->online.front().stamp_ns;
  std::vector<CaptionedPlot> plots;
  if (source.evaluation) add_true_errors(*source.evaluation, begin_ns, plots);
  if (!source.result->uncertain.empty()) plots.push_back(sigma_plot(*source.result, begin_ns));
  return plots;
}

std::string error_figures(const ReportSource& source) {
  std::string html;
  for (const CaptionedPlot& one : error_plots(source))
    html += "<figure>" + to_svg(one.plot) + "<figcaption>" + one.caption + "</figcaption></figure>";
  return html.empty() ? html : "<section><h2>Errors over time</h2>" + html + "</section>";
}

}  // namespace slammot::evaluator
