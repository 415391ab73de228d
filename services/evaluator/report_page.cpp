#include "services/evaluator/report_page.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "common/files/text.hpp"
#include "services/evaluator/figures.hpp"
#include "services/evaluator/report_assumptions.hpp"
#include "services/evaluator/report_player.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

using files::text;

std::string cell(const std::string& content) { return "<td>" + escaped(content) + "</td>"; }

std::string errors_row(const char* name, const metrics::ErrorSummary& errors, const char* unit) {
  if (errors.count == 0) return {};
  return "<tr><th>" + std::string(name) + "</th>" + cell(text("%.3f %s", errors.rmse, unit)) +
         cell(text("%.3f", errors.mean)) + cell(text("%.3f", errors.median)) +
         cell(text("%.3f", errors.max)) + "</tr>";
}

std::string trajectory_rows(const char* name, const TrajectoryEvaluation& trajectory) {
  std::string rows = "<tr><th colspan=\"5\">" + std::string(name) + "</th></tr>" +
                     errors_row("position (ATE)", trajectory.absolute_m, "m");
  for (const RelativeErrors& relative : trajectory.relative)
    rows += errors_row(text("motion over %g m", relative.delta_m).c_str(), relative.drift_m, "m");
  return rows;
}

std::string tracking_table(const TrackingEvaluation& tracking) {
  std::string html =
      "<table><caption>Tracks against true objects, "
      "live</caption><tr><th>HOTA</th><th>MOTA</th><th>IDF1</th><th>recall</th><th>precision</"
      "th><th>switches</th>"
      "<th>centre, median</th><th>velocity, median</th><th>velocity, RMS</th><th>delay, "
      "median</th></tr><tr>";
  const metrics::ObjectErrors& all = tracking.errors.all;
  html += cell(text("%.3f", tracking.hota.hota)) + cell(text("%.3f", tracking.clear.mota)) +
          cell(text("%.3f", tracking.identity.f1)) + cell(text("%.3f", tracking.clear.recall)) +
          cell(text("%.3f", tracking.clear.precision)) +
          cell(text("%zu", tracking.clear.switches)) + cell(text("%.2f m", all.centre_m.median)) +
          cell(text("%.2f m/s", all.velocity_mps.median)) +
          cell(text("%.2f m/s", all.velocity_mps.rmse)) +
          cell(text("%.2f s", tracking.errors.detection_delay_s.median));
  return html + "</tr></table>";
}

std::string figures_section(const Evaluation& evaluation) {
  std::string html =
      "<section><h2>Evaluation against ground "
      "truth</h2><table><caption>Trajectory</caption><tr><th></th><th>RMS</th><th>mean</"
      "th><th>median</th><th>largest</th></tr>";
  html += trajectory_rows("after the last correction", evaluation.corrected) +
          trajectory_rows("as published live", evaluation.online);
  if (evaluation.without_loops)
    html += trajectory_rows("without loops (frame odom)", *evaluation.without_loops);
  html += "</table>";
  if (evaluation.tracking) html += tracking_table(*evaluation.tracking);
  if (evaluation.other_car) {
    const OtherCarEvaluation& car = *evaluation.other_car;
    html += "<p>" +
            text(
                "The other car: position %.3f m RMS, velocity %.3f m/s RMS, %zu identities, %.2f "
                "false moving tracks a scan.",
                car.position_m.rmse, car.velocity_mps.rmse, car.identities,
                car.false_moving_tracks_a_scan) +
            "</p>";
  }
  if (evaluation.relative_pose_nees && evaluation.relative_pose_nees->samples > 0) {
    const metrics::NeesSummary& nees = *evaluation.relative_pose_nees;
    html += "<p>" +
            text(
                "NEES of the motion over one second: %.2f (three degrees of freedom, 95 %% band "
                "%.2f to %.2f).",
                nees.mean, nees.band_low, nees.band_high) +
            "</p>";
  }
  if (evaluation.map) {
    html +=
        "<p>" +
        text("Map: precision %.3f, recall %.3f, residue of movers %.2f %% of the occupied cells.",
             evaluation.map->precision(), evaluation.map->recall(),
             100.0 * evaluation.map->residue()) +
        "</p>";
  }
  for (const std::string& note : evaluation.notes)
    html += "<p class=\"about\">" + escaped(note) + ".</p>";
  return html + "</section>";
}

/// One-line summary of report.json.
std::string about(const std::string& report_json) {
  const auto report = nlohmann::json::parse(report_json, nullptr, false);
  if (!report.is_object()) return {};
  const auto value = [&](const char* place) {
    const nlohmann::json::json_pointer pointer{place};
    if (!report.contains(pointer)) return std::string("?");
    const auto& found = report[pointer];
    return found.is_string()         ? found.get<std::string>()
           : found.is_number_float() ? svg_number(std::round(found.get<double>() * 10.0) / 10.0)
                                     : found.dump();
  };
  return "<p class=\"about\">" +
         escaped(value("/program") + " " + value("/command") + ", " + value("/input/file") +
                 ", profile " + value("/profile") + ": " + value("/counts/scans") + " scans, " +
                 value("/input/duration_s") + " s, " + value("/distance_m") + " m, " +
                 value("/counts/confirmed_tracks") + " confirmed tracks, " +
                 value("/counts/submaps") + " submaps, " + value("/measured/real_time_factor") +
                 " times real time.") +
         "</p>";
}

}  // namespace

std::string to_html(const ReportSource& source) {
  const std::string& report_json = source.result->report_json;
  std::string html = page_head(source.title) + "<body>" + player_of(*source.result) + "<main><h1>" +
                     escaped(source.title) + "</h1>" + about(report_json) +
                     doubts_section(*source.result) + assumptions_section(report_json);
  if (source.evaluation) html += figures_section(*source.evaluation);
  html += error_figures(source) + detection_figures(source) + track_figures(source) +
          closures_section(report_json) + latency_figure(source);
  return html + "</main></body></html>\n";
}

}  // namespace slammot::evaluator
