#include "common/files/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace slammot::files {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(LogClock clock) {
  switch (clock) {
    case LogClock::kIpc: return "ipc_timestamp";
    case LogClock::kLogger: return "logger_timestamp";
    case LogClock::kNominal: return "nominal";
  }
  return "";
}

const char* name_of(OdometrySource source) {
  switch (source) {
    case OdometrySource::kNone: return "none";
    case OdometrySource::kLaserRecords: return "laser_records";
    case OdometrySource::kOdomLines: return "odom_lines";
    case OdometrySource::kBoth: return "laser_records_and_odom_lines";
  }
  return "";
}

/// Four decimals are enough for a reader.
double short_number(double value) { return std::isfinite(value) ? std::round(value * 1e4) / 1e4 : 0.0; }

Json input_of(const RunReport& report) {
  const LogFigures& figures = report.plan.figures;
  return {{"file", report.input},
          {"clock", name_of(report.plan.clock)},
          {"odometry", name_of(report.plan.odometry)},
          {"duration_s", short_number(figures.duration_s)},
          {"odometry_distance_m", short_number(figures.distance_m)},
          {"beams", figures.beams},
          {"field_of_view_rad", short_number(figures.field_of_view_rad)},
          {"max_range_m", short_number(figures.max_range_m)},
          {"scan_period_s", short_number(figures.scan_period_s)},
          {"sweep_s", short_number(report.sweep_s)},
          {"laser_ahead_m", short_number(report.plan.base_from_laser.x_m)},
          {"laser_left_m", short_number(report.plan.base_from_laser.y_m)},
          {"laser_heading_rad", short_number(report.plan.base_from_laser.heading_rad)},
          {"cruising_speed_mps", short_number(figures.cruising_speed_mps)},
          {"malformed_lines", report.faults.malformed_lines},
          {"first_malformed_lines", report.faults.first_malformed_lines},
          {"overlong_lines", report.faults.overlong_lines},
          {"ignored_lines", report.faults.ignored_lines},
          {"stale_odometry", report.faults.stale_odometry},
          {"is_cut", report.faults.is_cut}};
}

Json counts_of(const RunRecord& record) {
  const auto constraints = record.constraints();
  const auto loops = std::count_if(constraints.begin(), constraints.end(), [](const flow::Constraint& constraint) { return constraint.kind == flow::ConstraintKind::kLoop; });
  return {{"scans", record.scans()},
          {"localized_scans", record.localized_scans()},
          {"confirmed_tracks", record.confirmed_tracks()},
          {"track_rows", record.track_rows().size()},
          {"submaps", record.submaps().size()},
          {"constraints", constraints.size()},
          {"loop_constraints", loops}};
}

Json measured_of(const MeasuredRun& measured) {
  Json latency = Json::object();
  for (const StageLatency& stage : measured.stages) {
    latency[stage.stage] = {{"calls", stage.calls}, {"p50_ms", short_number(stage.p50_ms)}, {"p99_ms", short_number(stage.p99_ms)}, {"max_ms", short_number(stage.max_ms)}};
  }
  return {{"stage_latency", latency},
          {"wall_s", short_number(measured.wall_s)},
          {"real_time_factor", short_number(measured.real_time_factor)},
          {"peak_memory_mb", short_number(measured.peak_memory_mb)}};
}

}  // namespace

StageLatency summarize_latency(std::string stage, std::vector<double> durations_ms) {
  StageLatency latency;
  latency.stage = std::move(stage);
  latency.calls = durations_ms.size();
  if (durations_ms.empty()) return latency;
  std::sort(durations_ms.begin(), durations_ms.end());
  const auto at = [&](double share) { return durations_ms[static_cast<std::size_t>(share * static_cast<double>(durations_ms.size() - 1))]; };
  latency.p50_ms = at(0.5);
  latency.p99_ms = at(0.99);
  latency.max_ms = durations_ms.back();
  return latency;
}

std::string to_json_text(const RunRecord& record, const RunReport& report, double travelled_m) {
  Json json = {{"program", "slammot " + report.version},
               {"command", report.command},
               {"profile", report.profile},
               {"profile_reason", report.profile_reason},
               {"is_interrupted", report.is_interrupted},
               {"input", input_of(report)},
               {"counts", counts_of(record)},
               {"distance_m", short_number(travelled_m)},
               {"counters", report.counters},
               {"measured", measured_of(report.measured)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace slammot::files
