#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/files/carmen_log.hpp"
#include "common/files/log_plan.hpp"
#include "common/files/run_record.hpp"
#include "common/files/street_findings.hpp"
#include "common/sensing/gyro_odometry.hpp"
#include "common/sensing/odometry_episodes.hpp"

namespace slammot::files {

/// How long one stage took for a scan.
struct StageLatency {
  std::string stage;
  std::uint64_t calls = 0;
  double p50_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

/// Measured by the machine's clock, therefore different in each run.
struct MeasuredRun {
  std::vector<StageLatency> stages;
  double wall_s = 0.0;
  double real_time_factor = 0.0;  ///< Seconds of driving processed per second.
  double peak_memory_mb = 0.0;
};

/// A time in which scans did not match the map, since the first scan.
struct LossOfPlace {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// Properties of a run that are not in RunRecord.
struct RunReport {
  std::string command;  ///< "run" or "bench".
  std::string version;
  std::string input;  ///< File name, without its folder.
  std::string profile;
  std::string profile_reason;
  std::vector<std::string> replaced_stages;  ///< "tracking: greedy", of each whose implementation
                                             ///< is not the default.
  bool is_of_drive = true;  ///< False: of maps, named by `input`; without a log and a profile.
  LogPlan plan;
  double sweep_s = 0.0;  ///< Assumed time from the first to the last beam.
  LogFaults faults;
  bool is_interrupted = false;  ///< The user interrupted it before the end of the drive.
  std::map<std::string, std::map<std::string, std::uint64_t>> counters;  ///< By stage and name.
  std::vector<LossOfPlace> losses;     ///< Of localization, where known.
  bool is_in_stored_map = false;       ///< The drive continues a map: it is located there or not.
  std::optional<double> located_at_s;  ///< Since the first scan; poses as published before are in
                                       ///< another frame than the map's.
  std::optional<sensing::OdometryConclusions> odometry;  ///< None if not recorded.
  std::optional<sensing::GyroUse> gyro;                  ///< None without an IMU.
  std::optional<StreetFindings> streets;                 ///< None without a street graph.
  MeasuredRun measured;
};

/// Order statistics of one stage's durations.
StageLatency summarize_latency(std::string stage, std::vector<double> durations_ms);

/// The report as JSON. All but its last member, "measured", depends only on input and
/// configuration.
std::string to_json_text(const RunRecord& record, const RunReport& report, double travelled_m);

}  // namespace slammot::files
