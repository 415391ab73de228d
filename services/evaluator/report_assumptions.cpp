#include "services/evaluator/report_assumptions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/files/text.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

using files::text;
using Json = nlohmann::ordered_json;

std::string word(const Json& object, const char* name) {
  return object.contains(name) && object[name].is_string() ? object[name].get<std::string>()
                                                           : std::string();
}

double number(const Json& object, const char* name) {
  return object.contains(name) && object[name].is_number() ? object[name].get<double>() : 0.0;
}

std::string row(const char* name, const std::string& content) {
  return content.empty()
             ? std::string()
             : "<tr><th>" + std::string(name) + "</th><td>" + escaped(content) + "</td></tr>";
}

std::string clock_text(const Json& input) {
  const std::string clock = word(input, "clock");
  const std::string fault = word(input, "clock_fault");
  std::string words = clock == "nominal" ? "none that is usable: stamps are reconstructed" : clock;
  if (!fault.empty() && fault != "none") words += " (" + fault + ")";
  if (input.contains("time_is_known") && input["time_is_known"] == false)
    words += "; speeds are not known in seconds";
  return words;
}

std::string mounting_text(const Json& input) {
  return text("%.2f m ahead of the base, %.2f m to its left, turned by %.1f degrees",
              number(input, "laser_ahead_m"), number(input, "laser_left_m"),
              number(input, "laser_heading_rad") * 180.0 / std::numbers::pi);
}

std::string scanner_text(const Json& input) {
  return text("%.0f beams over %.0f degrees up to %.0f m, every %.1f ms, swept in %.1f ms",
              number(input, "beams"),
              std::round(number(input, "field_of_view_rad") * 180.0 / std::numbers::pi),
              number(input, "max_range_m"), number(input, "scan_period_s") * 1e3,
              number(input, "sweep_s") * 1e3);
}

std::string odometry_text(const Json& report, const Json& input) {
  std::string source = word(input, "odometry");
  std::ranges::replace(source, '_', ' ');
  if (source == "none") source = "none: scans alone give the motion";
  const std::string conclusion =
      report.contains("odometry") ? word(report["odometry"], "conclusion") : std::string();
  return conclusion.empty() ? source : source + "; " + conclusion;
}

std::string gyro_row(const Json& report) {
  if (!report.contains("gyro")) return {};
  return row("gyro", word(report["gyro"], "conclusion"));
}

std::string findings_rows(const Json& input) {
  std::string rows;
  if (!input.contains("findings") || !input["findings"].is_array()) return rows;
  for (const Json& finding : input["findings"])
    if (finding.is_string()) rows += row("doubtful", finding.get<std::string>());
  return rows;
}

std::optional<Json> parsed(const std::string& report_json) {
  Json report = Json::parse(report_json, nullptr, false);
  return report.is_object() ? std::optional(std::move(report)) : std::nullopt;
}

}  // namespace

std::string assumptions_section(const std::string& report_json) {
  const auto report = parsed(report_json);
  if (!report || !report->contains("input") || !(*report)["input"].is_object()) return {};
  const Json& input = (*report)["input"];
  std::string profile = word(*report, "profile");
  if (const std::string reason = word(*report, "profile_reason"); !reason.empty())
    profile += " (" + reason + ")";
  return "<section><h2>What was assumed</h2><table class=\"words\">" +
         row("clock", clock_text(input)) + row("odometry", odometry_text(*report, input)) +
         gyro_row(*report) + row("scanner", scanner_text(input)) +
         row("mounting", mounting_text(input)) + row("profile", profile) + findings_rows(input) +
         "</table></section>";
}

std::string closures_section(const std::string& report_json) {
  const auto report = parsed(report_json);
  if (!report || !report->contains("closures") || !(*report)["closures"].is_array()) return {};
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const Json& closure : (*report)["closures"])
    if (closure.is_object()) ++counts[{word(closure, "state"), word(closure, "reason")}];
  if (counts.empty()) return {};
  std::string html =
      "<section><h2>Loop closures</h2><table class=\"words\"><tr><th>state</th><th>reason</th>"
      "<th>closures</th></tr>";
  for (const auto& [kind, count] : counts)
    html += "<tr><td>" + escaped(kind.first) + "</td><td>" + escaped(kind.second) + "</td><td>" +
            std::to_string(count) + "</td></tr>";
  return html + "</table></section>";
}

}  // namespace slammot::evaluator
