#include "common/files/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/files/georeference_findings.hpp"
#include "common/files/log_findings.hpp"
#include "common/files/odometry_findings.hpp"

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
double short_number(double value) {
  return std::isfinite(value) ? std::round(value * 1e4) / 1e4 : 0.0;
}

Json input_of(const RunReport& report) {
  const LogFigures& figures = report.plan.figures;
  return {{"file", report.input},
          {"clock", name_of(report.plan.clock)},
          {"clock_fault", files::name_of(report.plan.times.fault)},
          {"time_is_known", figures.has_clock},
          {"odometry", name_of(report.plan.odometry)},
          {"findings", describe_findings(report.plan)},
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

/// What the quick match of pairs of scans said; 0 for scales that it could not tell.
Json evidence_of(const matching::LogEvidence& evidence) {
  return {{"matched_pairs", evidence.pairs},
          {"turning_pairs", evidence.turning_pairs},
          {"matched_share", short_number(evidence.matched_share)},
          {"turn_sign_share", short_number(evidence.turn_sign_share)},
          {"turn_scale", short_number(evidence.turn_scale)},
          {"way_scale", short_number(evidence.way_scale)}};
}

Json counts_of(const RunRecord& record) {
  const auto constraints = record.constraints();
  const auto loops =
      std::count_if(constraints.begin(), constraints.end(), [](const flow::Constraint& constraint) {
        return constraint.kind == flow::ConstraintKind::kLoop &&
               constraint.verdict.state == flow::ClosureState::kAccepted;
      });
  const auto in_graph =
      std::count_if(constraints.begin(), constraints.end(), [](const flow::Constraint& constraint) {
        return constraint.verdict.state == flow::ClosureState::kAccepted;
      });
  return {{"scans", record.scans()},
          {"localized_scans", record.localized_scans()},
          {"confirmed_tracks", record.confirmed_tracks()},
          {"track_rows", record.track_rows().size()},
          {"submaps", record.submaps().size()},
          {"constraints", in_graph},
          {"loop_constraints", loops}};
}

Json closures_of(const RunRecord& record) {
  Json closures = Json::array();
  for (const flow::Constraint& closure : record.constraints()) {
    if (closure.kind != flow::ConstraintKind::kLoop) continue;
    const geometry::Pose2& pose = closure.from_to.pose;
    closures.push_back({{"from", closure.from.value},
                        {"to", closure.to.value},
                        {"state", flow::to_text(closure.verdict.state)},
                        {"x_m", short_number(pose.x_m)},
                        {"y_m", short_number(pose.y_m)},
                        {"heading_rad", short_number(pose.heading_rad)},
                        {"chi_square", short_number(closure.verdict.squared_error)},
                        {"agreed_share", short_number(closure.verdict.agreed_share)},
                        {"reason", closure.verdict.reason}});
  }
  return closures;
}

Json episode_of(const sensing::OdometryEpisode& episode,
                const sensing::OdometryConclusions& odometry) {
  return {{"fault", files::name_of(episode.fault)},
          {"begin_s",
           short_number(static_cast<double>(episode.begin_ns - odometry.first_stamp_ns) * 1e-9)},
          {"duration_s", short_number(episode.duration_s())},
          {"first_scan", episode.first_scan},
          {"scans", episode.scans},
          {"way_by_odometry_m", short_number(episode.way_by_wheels_m)},
          {"way_by_scans_m", short_number(episode.way_by_matches_m)},
          {"turn_by_odometry_rad", short_number(episode.turn_by_wheels_rad)},
          {"turn_by_scans_rad", short_number(episode.turn_by_matches_rad)}};
}

Json factors_of(const sensing::WheelFactors& factors) {
  return {{"way_factor", short_number(factors.way)},
          {"turn_factor", short_number(factors.turn)},
          {"yaw_bias_radps", short_number(factors.turn_bias_radps)}};
}

Json gyro_of(const sensing::GyroUse& gyro) {
  return {{"conclusion", describe_gyro(gyro)},
          {"read_s", short_number(gyro.read_s)},
          {"used_s", short_number(gyro.used_s)},
          {"bias_radps", short_number(gyro.bias_radps)},
          {"turn_ratio", short_number(gyro.turn_ratio)}};
}

Json odometry_of(const sensing::OdometryConclusions& odometry, bool time_is_known) {
  Json recalibrations = Json::array();
  for (const sensing::OdometryRecalibration& one : odometry.recalibrations) {
    recalibrations.push_back(
        {{"at_s", short_number(static_cast<double>(one.stamp_ns - odometry.first_stamp_ns) * 1e-9)},
         {"scan", one.scan}});
    recalibrations.back().update(factors_of(one.factors));
  }
  Json episodes = Json::array();
  for (const sensing::OdometryEpisode& episode : odometry.episodes)
    episodes.push_back(episode_of(episode, odometry));
  Json json = {{"conclusion", describe_odometry(odometry, time_is_known)},
               {"steps", odometry.steps},
               {"with_odometry", odometry.with_odometry},
               {"disbelieved", odometry.disbelieved}};
  json.update(factors_of(odometry.total));
  json["stamp_offset_s"] = short_number(odometry.stamp_offset_s);
  json["recalibrations"] = recalibrations;
  json["episodes"] = episodes;
  json["more_episodes"] = odometry.more_episodes;
  return json;
}

/// Latitude and longitude with nine decimals: a tenth of a millimetre.
Json georeference_of(const flow::Georeference& found) {
  Json json = {{"conclusion", describe_georeference(found)},
               {"fixes", found.fixes},
               {"rejected_fixes", found.rejected_fixes},
               {"fix_sigma_m", short_number(found.fix_sigma_m)},
               {"headings", found.headings},
               {"rejected_headings", found.rejected_headings},
               {"compass_bias_rad", short_number(found.compass_bias_rad)},
               {"corrects_map", found.corrects_map}};
  if (found.has_position) {
    json["origin_latitude_deg"] = std::round(found.origin.latitude_deg * 1e9) / 1e9;
    json["origin_longitude_deg"] = std::round(found.origin.longitude_deg * 1e9) / 1e9;
    json["origin_sigma_m"] = short_number(found.position_sigma_m);
  }
  if (found.has_direction) {
    json["x_from_east_rad"] = short_number(found.x_from_east_rad);
    json["x_from_east_sigma_rad"] = short_number(found.direction_sigma_rad);
  }
  return json;
}

Json losses_of(const RunReport& report) {
  Json losses = Json::array();
  for (const LossOfPlace& loss : report.losses)
    losses.push_back(
        {{"begin_s", short_number(loss.begin_s)}, {"end_s", short_number(loss.end_s)}});
  return losses;
}

Json measured_of(const MeasuredRun& measured) {
  Json latency = Json::object();
  for (const StageLatency& stage : measured.stages) {
    latency[stage.stage] = {{"calls", stage.calls},
                            {"p50_ms", short_number(stage.p50_ms)},
                            {"p99_ms", short_number(stage.p99_ms)},
                            {"max_ms", short_number(stage.max_ms)}};
  }
  return {{"stage_latency", latency},
          {"wall_s", short_number(measured.wall_s)},
          {"real_time_factor", short_number(measured.real_time_factor)},
          {"peak_memory_mb", short_number(measured.peak_memory_mb)}};
}

/// What the result was made of.
Json source_of(const RunReport& report) {
  Json json = {{"program", "slammot " + report.version}, {"command", report.command}};
  if (!report.is_of_drive) {
    json["maps"] = report.input;
    return json;
  }
  json.update({{"profile", report.profile},
               {"profile_reason", report.profile_reason},
               {"is_interrupted", report.is_interrupted},
               {"input", input_of(report)},
               {"scan_pairs", evidence_of(report.plan.evidence)}});
  return json;
}

}  // namespace

StageLatency summarize_latency(std::string stage, std::vector<double> durations_ms) {
  StageLatency latency;
  latency.stage = std::move(stage);
  latency.calls = durations_ms.size();
  if (durations_ms.empty()) return latency;
  std::sort(durations_ms.begin(), durations_ms.end());
  const auto at = [&](double share) {
    return durations_ms[static_cast<std::size_t>(share *
                                                 static_cast<double>(durations_ms.size() - 1))];
  };
  latency.p50_ms = at(0.5);
  latency.p99_ms = at(0.99);
  latency.max_ms = durations_ms.back();
  return latency;
}

std::string to_json_text(const RunRecord& record, const RunReport& report, double travelled_m) {
  Json json = source_of(report);
  json.update({{"counts", counts_of(record)},
               {"distance_m", short_number(travelled_m)},
               {"counters", report.counters},
               {"closures", closures_of(record)}});
  if (!report.losses.empty()) json["losses"] = losses_of(report);
  if (report.is_in_stored_map)
    json["located_at_s"] = report.located_at_s ? Json(short_number(*report.located_at_s)) : Json();
  if (!report.replaced_stages.empty()) json["replaced_stages"] = report.replaced_stages;
  if (report.gyro) json["gyro"] = gyro_of(*report.gyro);
  if (report.odometry)
    json["odometry"] = odometry_of(*report.odometry, report.plan.figures.has_clock);
  if (record.georeference()) json["georeference"] = georeference_of(*record.georeference());
  if (report.streets) json["streets"] = Json::parse(to_json_text(*report.streets));
  json["measured"] = measured_of(report.measured);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace slammot::files
