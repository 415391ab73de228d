#include "services/slammot/job_text.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>

#include "common/files/georeference_findings.hpp"
#include "common/files/log_findings.hpp"
#include "common/files/odometry_findings.hpp"
#include "common/files/text.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/implementations.hpp"

namespace slammot {
namespace {

using files::text;

/// Counts of scans that were not localized, by reason, and of scans without a match; empty if there
/// are none.
std::string describe_left_out(const files::RunRecord& record, const files::RunReport& report) {
  constexpr std::pair<const char*, const char*> kReasons[] = {
      {"duplicate_scans", "repeat an earlier stamp"},
      {"out_of_order_scans", "are older than an earlier one"},
      {"far_ahead_scans", "have a stamp far ahead of all others"}};
  const auto stage = report.counters.find("localization");
  if (stage == report.counters.end()) return {};
  const auto count_of = [&](const char* counter) {
    const auto count = stage->second.find(counter);
    return static_cast<unsigned long long>(count == stage->second.end() ? 0 : count->second);
  };
  std::string reasons;
  for (const auto& [counter, reason] : kReasons) {
    if (const auto count = count_of(counter); count > 0)
      reasons += text("%s%llu %s", reasons.empty() ? "" : ", ", count, reason);
  }
  std::string lines;
  if (record.localized_scans() < record.scans() && !reasons.empty())
    lines += "not localized: " + reasons + "\n";
  if (const auto frozen = count_of("frozen_scans"); frozen > 0)
    lines += text(
        "warning:  %llu scans repeat the readings of the one before while odometry moves (the "
        "scanner hangs): not used\n",
        frozen);
  if (const auto with_floor = count_of("scans_with_floor"); with_floor > 0)
    lines += text(
        "warning:  %llu scans localized without the floor that the scanner looks down at: it was "
        "found while driving\n",
        with_floor);
  if (const auto blank = count_of("blank_scans"); blank > 0)
    lines += text(
        "warning:  %llu scans have no valid reading (NaN), or hardly an echo where the map expects "
        "many: poses and tracks predicted\n",
        blank);
  if (const auto few = count_of("too_few_echoes"); few > 0)
    lines += text("warning:  %llu scans had too few echoes to be matched: dead reckoning\n", few);
  return lines;
}

std::string describe_faults(const files::LogFaults& faults) {
  std::string lines;
  for (const std::string& skipped : describe_skipped(faults))
    lines += "warning:  " + skipped + "\n";
  return lines;
}

/// A floor that was taken for a wall; one that is left out is told before the drive.
std::string describe_floor_in_map(const files::LogPlan& plan) {
  std::string lines;
  if (!files::takes_floor_for_wall(plan)) return lines;
  for (const std::string& finding : files::describe_floor(plan))
    lines += "warning:  " + finding + "\n";
  return lines;
}

}  // namespace

std::vector<std::string> describe_skipped(const files::LogFaults& faults) {
  std::vector<std::string> skipped;
  if (faults.malformed_lines > 0) {
    skipped.push_back(text("malformed lines of the log, skipped: %llu; the first:",
                           static_cast<unsigned long long>(faults.malformed_lines)));
    for (const std::uint64_t line : faults.first_malformed_lines)
      skipped.back() += text(" %llu", static_cast<unsigned long long>(line));
  }
  if (faults.overlong_lines > 0)
    skipped.push_back(text("overlong lines of the log, skipped: %llu",
                           static_cast<unsigned long long>(faults.overlong_lines)));
  return skipped;
}

std::string name_of_drive(const JobOptions& options) {
  if (options.scenario.empty()) return options.input.filename().string();
  return options.scenario + (options.seed ? " (seed " + std::to_string(*options.seed) + ")" : "");
}

std::string describe_job(const Job& job, const JobOptions& options) {
  const files::LogFigures& figures = job.log.plan().figures;
  std::string lines = text(
      "%s %s: %llu scans of %zu beams over %.0f degrees, %.0f s",
      options.scenario.empty() ? "log:     " : "scenario:", name_of_drive(options).c_str(),
      static_cast<unsigned long long>(figures.scans), figures.beams,
      std::floor(figures.field_of_view_rad * 180.0 / std::numbers::pi + 0.25), figures.duration_s);
  lines += "\n";
  lines += files::describe(job.log.topics());
  lines += files::describe_scanners(job.log.plan());
  if (options.scenario.empty())
    lines += "odometry: " + files::describe_odometry(job.log.plan()) + "\n";
  for (const std::string& doubt : job.log.topics().doubts) lines += "warning:  " + doubt + "\n";
  for (const std::string& finding : files::describe_findings(job.log.plan()))
    lines += "warning:  " + finding + "\n";
  for (const std::string& stage : replaced_stages(job.profile.implementations))
    lines += "replaced: " + stage + "\n";
  return lines + text("profile:  %s (%s)\n", job.profile_name.c_str(), job.profile_reason.c_str());
}

std::string describe_outcome(const files::RunRecord& record, const files::RunReport& report,
                             const std::filesystem::path& output) {
  std::string lines =
      report.odometry
          ? "odometry: " +
                files::describe_odometry(*report.odometry, report.plan.figures.has_clock) + "\n"
          : std::string();
  if (report.gyro) lines += "gyro:     " + files::describe_gyro(*report.gyro) + "\n";
  if (record.georeference())
    lines += "position: " + files::describe_georeference(*record.georeference()) + "\n";
  if (report.streets) lines += "streets:  " + files::describe_streets(*report.streets) + "\n";
  lines += text("%-14s %10s %10s %10s\n", "stage", "p50 [ms]", "p99 [ms]", "max [ms]");
  for (const files::StageLatency& stage : report.measured.stages) {
    lines += text("%-14s %10.3f %10.3f %10.3f\n", stage.stage.c_str(), stage.p50_ms, stage.p99_ms,
                  stage.max_ms);
  }
  lines +=
      text("%llu scans, %llu of them localized; %llu confirmed tracks; %zu submaps\n",
           static_cast<unsigned long long>(record.scans()),
           static_cast<unsigned long long>(record.localized_scans()),
           static_cast<unsigned long long>(record.confirmed_tracks()), record.submaps().size());
  lines += text("%.1f s of processing, %.1f times real time, %.0f MB peak memory\n",
                report.measured.wall_s, report.measured.real_time_factor,
                report.measured.peak_memory_mb);
  return lines + describe_floor_in_map(report.plan) + describe_left_out(record, report) +
         describe_faults(report.faults) + "results are in " + output.string() + "\n";
}

std::string describe_leftovers(const JobOptions& options) {
  std::string names;
  for (const char* name : {"map.sqlite", "evaluation.json", "collision_warnings.csv"}) {
    const bool is_replaced = options.stores_map && std::string_view(name) == "map.sqlite";
    if (!is_replaced && std::filesystem::exists(options.output / name))
      names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names.empty() ? names
                       : "warning:  of an earlier run, not of this one: " + names + " in " +
                             options.output.string() + "\n";
}

std::string where_damaged(const files::LogFaults& faults) {
  return faults.damage.empty() ? std::string() : " (" + faults.damage + ")";
}

int report_damage(const std::filesystem::path& log, const files::LogFaults& faults) {
  if (!faults.is_cut) return kExitDone;
  std::fprintf(stderr,
               "slammot: %s is cut off or damaged: only the readable part was processed%s\n",
               log.c_str(), where_damaged(faults).c_str());
  return kExitLogIsCut;
}

}  // namespace slammot
