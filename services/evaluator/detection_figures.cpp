#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "services/evaluator/figures.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

constexpr double kBucketS = 2.0;

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100.0 * share);
  return text;
}

std::string remark(const metrics::ObjectErrors& errors) {
  return percent(errors.recall) + " of " + std::to_string(errors.rows);
}

std::string recall_bars(const TrackingEvaluation& tracking) {
  std::vector<Bar> bars;
  for (const auto& [name, errors] : tracking.errors.by_class) {
    if (errors.rows > 0) bars.push_back({name, errors.recall, remark(errors)});
  }
  for (const metrics::DistanceBand& band : tracking.errors.by_distance) {
    bars.push_back({svg_number(band.from_m) + "-" + svg_number(band.to_m) + " m",
                    band.errors.recall, remark(band.errors)});
  }
  return "<figure>" + share_bars_svg(bars, "#1f5fa8") +
         "<figcaption>Recall: share of the rows of objects that count with a matched "
         "track.</figcaption></figure>";
}

/// Means of a count per scan over intervals of time.
class MeanOverTime {
 public:
  void add(double at_s, double value) {
    const auto bucket = static_cast<std::size_t>(std::max(0.0, at_s) / kBucketS);
    if (sums_.size() <= bucket) sums_.resize(bucket + 1);
    sums_[bucket].first += value;
    sums_[bucket].second += 1.0;
  }
  std::vector<PlotPoint> points() const {
    std::vector<PlotPoint> points;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      if (sums_[i].second > 0.0)
        points.push_back(
            {(static_cast<double>(i) + 0.5) * kBucketS, sums_[i].first / sums_[i].second});
    }
    return points;
  }

 private:
  std::vector<std::pair<double, double>> sums_;
};

std::string counts_over_time(const Evaluation& evaluation) {
  MeanOverTime objects, matched, false_tracks;
  const std::int64_t begin_ns = evaluation.scenes.front().stamp_ns;
  for (std::size_t i = 0; i < evaluation.counted.size(); ++i) {
    const metrics::CountedScene& scene = evaluation.counted[i];
    const double at_s = static_cast<double>(scene.frame.stamp_ns - begin_ns) * 1e-9;
    const auto matches = static_cast<double>(evaluation.tracking->clear.matches[i].size());
    objects.add(at_s, static_cast<double>(scene.objects.size()));
    matched.add(at_s, matches);
    false_tracks.add(at_s, static_cast<double>(scene.tracks.size()) - matches);
  }
  const Plot plot{"time [s]",
                  "a scan",
                  {{"objects that count", "#111", objects.points(), 0.0, true},
                   {"of them tracked", "#1f5fa8", matched.points()},
                   {"false tracks", "#d9480f", false_tracks.points()}},
                  {},
                  {}};
  return "<figure>" + to_svg(plot) + "<figcaption>Means over two seconds.</figcaption></figure>";
}

std::string counts_row(const char* name, const metrics::DetectionCounts& counts) {
  std::string row = std::string("<tr><th>") + name + "</th>";
  for (const double share :
       {counts.moving_precision(), counts.moving_recall(), counts.stationary_precision(),
        counts.stationary_recall(), counts.segment_precision(), counts.segment_recall()})
    row += "<td>" + percent(share) + "</td>";
  return row + "</tr>";
}

std::string label_table(const DetectionEvaluation& detection) {
  return "<table><caption>Labels of echoes against their true "
         "origin</caption><tr><th></th><th>moving: precision</th><th>recall</th><th>stationary: "
         "precision</th><th>recall</th>"
         "<th>segments: precision</th><th>recall</th></tr>" +
         counts_row("by detection", detection.by_detection) +
         counts_row("by tracking", detection.by_tracking) + "</table>";
}

}  // namespace

std::string detection_figures(const ReportSource& source) {
  const Evaluation* const evaluation = source.evaluation;
  if (!evaluation || !evaluation->tracking) return {};
  std::string html = "<section><h2>Detection and tracking</h2>";
  if (!evaluation->scenes.empty()) html += counts_over_time(*evaluation);
  html += recall_bars(*evaluation->tracking);
  if (evaluation->detection) html += label_table(*evaluation->detection);
  return html + "</section>";
}

std::string latency_figure(const ReportSource& source) {
  const auto report =
      nlohmann::ordered_json::parse(source.result->report_json, nullptr, false);  // Stages in the
                                                                                  // order of
                                                                                  // processing.
  const nlohmann::ordered_json::json_pointer place("/measured/stage_latency");
  if (!report.is_object() || !report.contains(place) || !report[place].is_object()) return {};
  std::vector<LogBar> bars;
  for (const auto& [stage, latency] : report[place].items())
    bars.push_back({stage, latency.value("p50_ms", 0.0), latency.value("p99_ms", 0.0),
                    latency.value("max_ms", 0.0)});
  const std::string svg = log_bars_svg(bars, "milliseconds a call");
  if (svg.empty()) return {};
  return "<section><h2>Latency of the stages</h2><figure>" + svg +
         "<p class=\"legend\"><span><i style=\"background:#1f5fa8\"></i>median</span><span><i "
         "style=\"background:#e0a100\"></i>99th percentile</span>"
         "<span><i style=\"background:#d9480f\"></i>maximum</span></p><figcaption>Measured on the "
         "machine of the run.</figcaption></figure></section>";
}

}  // namespace slammot::evaluator
