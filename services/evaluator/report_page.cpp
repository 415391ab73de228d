#include "services/evaluator/report_page.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "common/files/text.hpp"
#include "services/evaluator/figures.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

using files::text;

constexpr const char* kStyle = R"(
:root { color: #1b1f24; background: #fff; font: 15px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
body { max-width: 62rem; margin: 0 auto; padding: 1.5rem 1rem 4rem; }
h1 { font-size: 1.5rem; margin: 0 0 .2rem; }
h2 { font-size: 1.15rem; margin: 2.4rem 0 .6rem; padding-bottom: .25rem; border-bottom: 1px solid #d8dde3; }
p.about { color: #57606a; margin: 0 0 1rem; }
figure { margin: 1rem 0 1.6rem; }
figcaption, caption { color: #57606a; font-size: .9rem; text-align: left; }
svg { display: block; width: 100%; height: auto; }
svg text { font-size: 12px; fill: #57606a; }
svg .grid { stroke: #e6e9ed; } svg .axis { stroke: #8c959f; }
svg .curve { fill: none; stroke-width: 1.5; stroke-linejoin: round; }
svg .shade { fill: #f1e4c3; } svg .trough { fill: #eef1f4; }
svg .range { stroke: #b8c0c8; stroke-width: 3; }
svg .low { fill: #1f5fa8; } svg .middle { fill: #e0a100; } svg .high { fill: #d9480f; }
svg.map { max-height: 80vh; background: #cdcdcd; border: 1px solid #d8dde3; }
svg.map image { image-rendering: pixelated; }
svg.map path { fill: none; vector-effect: non-scaling-stroke; stroke-linejoin: round; }
svg.map .way { stroke-width: 2.4; } svg.map .thin { stroke-width: 1.4; } svg.map .track { stroke-width: 1.3; stroke-opacity: .8; }
svg.map .dotted { stroke-width: 1.4; stroke-dasharray: 1 5; stroke-linecap: round; }
.legend { display: flex; flex-wrap: wrap; gap: .3rem 1.2rem; margin: .3rem 0; font-size: .85rem; color: #57606a; }
.legend i { display: inline-block; width: 1.1em; height: .35em; margin: 0 .4em .2em 0; }
.legend svg.key { display: inline-block; width: 24px; height: 8px; margin-right: .4em; }
table { border-collapse: collapse; margin: .6rem 0 1.2rem; font-size: .92rem; font-variant-numeric: tabular-nums; }
caption { padding-bottom: .3rem; }
th, td { padding: .25rem .8rem .25rem 0; text-align: right; border-bottom: 1px solid #e6e9ed; }
th { font-weight: 600; } th:first-child, td:first-child { text-align: left; }
)";

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
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>" +
      escaped(source.title) + "</title><style>" + kStyle + "</style></head><body><h1>" +
      escaped(source.title) + "</h1>";
  html += about(source.report_json);
  html += map_figure(source);
  if (source.evaluation) html += figures_section(*source.evaluation);
  html += error_figures(source) + detection_figures(source) + track_figures(source) +
          latency_figure(source);
  return html + "</body></html>\n";
}

std::string to_base64(const std::string& bytes) {
  constexpr const char* kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t offset) {
      return i + offset < bytes.size() ? static_cast<unsigned char>(bytes[i + offset]) : 0U;
    };
    const unsigned group = byte(0) << 16 | byte(1) << 8 | byte(2);
    text += kLetters[group >> 18];
    text += kLetters[group >> 12 & 63U];
    text += i + 1 < bytes.size() ? kLetters[group >> 6 & 63U] : '=';
    text += i + 2 < bytes.size() ? kLetters[group & 63U] : '=';
  }
  return text;
}

}  // namespace slammot::evaluator
