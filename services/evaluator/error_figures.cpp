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

std::string figure(const Plot& plot, const char* caption) {
  return "<figure>" + to_svg(plot) + "<figcaption>" + caption + "</figcaption></figure>";
}

/// Published standard deviation of the pose relative to the local map.
std::string sigma_figure(const RunResult& result, std::int64_t begin_ns) {
  if (result.uncertain.empty()) return {};
  Series along{"position", kCorrected, {}};
  Series heading{"heading", kOnline, {}};
  for (const metrics::UncertainStampedPose& pose : result.uncertain) {
    const geometry::Matrix3& P = pose.odom_from_base.covariance;
    const double at_s = seconds_since(begin_ns, pose.stamp_ns);
    along.points.push_back({at_s, 100.0 * std::sqrt(std::max(P(0, 0), P(1, 1)))});
    heading.points.push_back({at_s, std::sqrt(P(2, 2)) * 180.0 / std::numbers::pi});
  }
  along.name = "position, worse of x and y [cm]";
  heading.name = "heading [deg]";
  return figure({"time [s]", "one sigma", {along, heading}, {}, {}, 190.0},
                "Published standard deviation of the pose relative to the local map.");
}

}  // namespace

std::string error_figures(const ReportSource& source) {
  const std::int64_t begin_ns = source.result->online.front().stamp_ns;
  std::string html;
  if (source.evaluation) {
    const TrajectoryEvaluation& corrected = source.evaluation->corrected;
    const TrajectoryEvaluation& online = source.evaluation->online;
    html += figure({"time [s]",
                    "position error [m]",
                    {absolute("as published live", kOnline, online, begin_ns),
                     absolute("after the last correction", kCorrected, corrected, begin_ns)},
                    {},
                    {}},
                   "Distance to the true position after rigid alignment.");
    constexpr double kDeltaM = 10.0;
    const RelativeSeries live = relative("as published live", kOnline, online, begin_ns, kDeltaM);
    const RelativeSeries best =
        relative("after the last correction", kCorrected, corrected, begin_ns, kDeltaM);
    if (!best.translation_m.points.empty()) {
      html +=
          figure({"time [s]", "over 10 m [m]", {live.translation_m, best.translation_m}, {}, {}},
                 "Position drift over ten metres of the true path.");
      html += figure(
          {"time [s]", "over 10 m [deg]", {live.rotation_deg, best.rotation_deg}, {}, {}, 190.0},
          "Heading drift over ten metres of the true path.");
    }
  }
  html += sigma_figure(*source.result, begin_ns);
  return html.empty() ? html : "<section><h2>Errors over time</h2>" + html + "</section>";
}

}  // namespace slammot::evaluator
