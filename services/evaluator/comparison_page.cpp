#include "services/evaluator/comparison_page.hpp"

#include <set>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "services/evaluator/doubts.hpp"
#include "services/evaluator/report_player.hpp"
#include "services/evaluator/stamps.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

using Json = nlohmann::ordered_json;

struct Figure {
  const char* name;
  const char* pointer;  ///< Into report.json.
};

constexpr Figure kFigures[] = {{"scans", "/counts/scans"},
                               {"localized scans", "/counts/localized_scans"},
                               {"confirmed tracks", "/counts/confirmed_tracks"},
                               {"rows of tracks", "/counts/track_rows"},
                               {"submaps", "/counts/submaps"},
                               {"closures in the graph", "/counts/loop_constraints"},
                               {"distance [m]", "/distance_m"},
                               {"times real time", "/measured/real_time_factor"},
                               {"wall time [s]", "/measured/wall_s"},
                               {"peak memory [MB]", "/measured/peak_memory_mb"}};

std::string number_at(const Json& report, const std::string& pointer) {
  const Json::json_pointer place(pointer);
  return report.is_object() && report.contains(place) && report[place].is_number()
             ? svg_number(report[place].get<double>())
             : "";
}

std::string row(const std::string& name, const std::string& a, const std::string& b) {
  if (a.empty() && b.empty()) return {};
  std::string difference;
  if (!a.empty() && !b.empty()) difference = svg_number(std::stod(b) - std::stod(a));
  return "<tr><th>" + escaped(name) + "</th><td>" + a + "</td><td>" + b + "</td><td>" +
         (difference == "0" ? "=" : difference) + "</td></tr>";
}

std::set<std::string> stages_of(const Json& report) {
  std::set<std::string> stages;
  const Json::json_pointer place("/measured/stage_latency");
  if (!report.is_object() || !report.contains(place) || !report[place].is_object()) return stages;
  for (const auto& [stage, latency] : report[place].items()) stages.insert(stage);
  return stages;
}

std::string latency_rows(const Json& a, const Json& b) {
  std::set<std::string> stages = stages_of(a);
  stages.merge(stages_of(b));
  std::string rows;
  for (const std::string& stage : stages) {
    for (const char* const figure : {"p50_ms", "p99_ms"}) {
      const std::string pointer = "/measured/stage_latency/" + stage + "/" + figure;
      rows += row(stage + (std::string(figure) == "p50_ms" ? ", median [ms]" : ", p99 [ms]"),
                  number_at(a, pointer), number_at(b, pointer));
    }
  }
  return rows;
}

std::string figures_table(const NamedResult& a, const NamedResult& b) {
  const Json of_a = Json::parse(a.result->report_json, nullptr, false);
  const Json of_b = Json::parse(b.result->report_json, nullptr, false);
  std::string rows;
  for (const Figure& figure : kFigures)
    rows += row(figure.name, number_at(of_a, figure.pointer), number_at(of_b, figure.pointer));
  rows += row("times with a doubtful pose", std::to_string(find_doubts(*a.result).size()),
              std::to_string(find_doubts(*b.result).size()));
  return "<table><tr><th></th><th>" + escaped(a.name) + "</th><th>" + escaped(b.name) +
         "</th><th>difference</th></tr>" + rows + latency_rows(of_a, of_b) + "</table>";
}

std::string distance_figure(const RunResult& a, const RunResult& b) {
  Series apart{"distance", "#1f5fa8", {}, 3.0};
  for (const metrics::StampedPose& pose : a.corrected) {
    const auto* other = at_stamp(b.corrected, pose.stamp_ns, kSameStampNs);
    if (other == nullptr) continue;
    const double at_s = static_cast<double>(pose.stamp_ns - a.corrected.front().stamp_ns) * 1e-9;
    apart.points.push_back(
        {at_s, (other->pose.translation_m() - pose.pose.translation_m()).norm()});
  }
  if (apart.points.empty()) return "<p>The results have no scan in common.</p>";
  return "<figure>" + to_svg({"time [s]", "apart [m]", {apart}, {}, {}, 180.0}) +
         "<figcaption>Distance between both trajectories after the last correction, in their own "
         "frames.</figcaption></figure>";
}

std::string tracks_figure(const NamedResult& a, const NamedResult& b) {
  const std::int64_t begin_ns = a.result->corrected.front().stamp_ns;
  std::vector<Series> series;
  for (const auto& [one, colour] : {std::pair(&a, "#1f5fa8"), std::pair(&b, "#d9480f")}) {
    Series counts{one->name, colour, {}, 3.0};
    for (const TracksAt& at : one->result->tracks)
      counts.points.push_back({static_cast<double>(at.stamp_ns - begin_ns) * 1e-9,
                               static_cast<double>(at.tracks.size())});
    series.push_back(std::move(counts));
  }
  return "<figure>" + to_svg({"time [s]", "confirmed tracks", series, {}, {}, 180.0}) + "</figure>";
}

std::string frame(const NamedResult& one) {
  return "<iframe title=\"" + escaped(one.name) + "\" srcdoc=\"" +
         escaped(player_page(*one.result, one.name)) + "\"></iframe>";
}

}  // namespace

std::string comparison_page(const NamedResult& a, const NamedResult& b) {
  const std::string title = "slammot: " + a.name + " and " + b.name;
  return page_head(title) + "<body><main class=\"wide\"><h1>" + escaped(a.name) + " · " +
         escaped(b.name) + "</h1><div class=\"pair\">" + frame(a) + frame(b) +
         "</div></main><main><section><h2>Figures</h2>" + figures_table(a, b) +
         "</section><section><h2>Over time</h2>" + distance_figure(*a.result, *b.result) +
         tracks_figure(a, b) + "</section></main><script>\n" +
         std::string(page_file("comparison.js")) + "</script></body></html>\n";
}

}  // namespace slammot::evaluator
