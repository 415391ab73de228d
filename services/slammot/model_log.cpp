#include "services/slammot/model_log.hpp"

#include <algorithm>

#include "services/evaluator/map_cells.hpp"

namespace slammot {
namespace {

using files::Error;

Error no_vertical_scanner(const ModelInput& input, const files::LogPlan& plan) {
  std::string names = files::enumerated(plan.scanners);
  for (const std::string& name : plan.unplaced_scanners) names += ", " + name;
  return Error{input.log.string() + ": no scanner of vertical profiles by the log (its scanners: " +
               names + "); --vertical NAME=AHEAD,LEFT,UP,ROLL,PITCH,HEADING states one"};
}

files::Result<std::vector<files::ScannerPlan>> chosen_scanners(const ModelInput& input,
                                                               const files::LogPlan& plan) {
  if (plan.profile_scanners.empty()) return no_vertical_scanner(input, plan);
  std::vector<files::ScannerPlan> scanners = plan.profile_scanners;
  if (auto fault = files::select_scanners(input.scanners, scanners))
    return Error{input.log.string() + ": " + fault->message + " that scan vertically"};
  return scanners;
}

files::Result<files::CarmenLog> open_log(const ModelInput& input) {
  files::CarmenLogOptions options;
  options.topics = input.topics;
  options.reads_profiles = true;
  return files::CarmenLog::open(input.log, options);
}

const files::ScannerPlan* plan_of(const sensing::LaserScan& scan,
                                  const std::vector<files::ScannerPlan>& scanners) {
  const auto plan = std::ranges::find_if(scanners, [&](const files::ScannerPlan& known) {
    return files::CarmenLog::scanner_id_of(known.name) == scan.scanner.scanner_id;
  });
  return plan == scanners.end() ? nullptr : &*plan;
}

}  // namespace

city_model::EstimatedDrive drive_of(const evaluator::RunResult& result) {
  city_model::EstimatedDrive drive{result.online, result.corrected, {}, {}};
  if (result.map) drive.stationary = evaluator::cells_of(*result.map);
  for (const evaluator::TracksAt& at : result.tracks) {
    for (const evaluator::ResultTrack& track : at.tracks) {
      if (track.is_occluded) continue;  // what is seen again tells where it was
      drive.movers.add(track.track_id, {at.stamp_ns, track.map_from_object,
                                        track.velocity_in_map_mps, track.length_m, track.width_m});
    }
  }
  return drive;
}

files::Result<ModelOfLog> model_of(const evaluator::RunResult& result, const ModelInput& input) {
  auto log = open_log(input);
  if (!log) return log.error();
  auto scanners = chosen_scanners(input, log->plan());
  if (!scanners) return scanners.error();
  const city_model::EstimatedDrive drive = drive_of(result);
  city_model::ProfileModel model(drive, {});
  ModelOfLog built;
  built.scanners = std::move(*scanners);
  while (auto event = log->next()) {
    auto* scan = std::get_if<sensing::LaserScan>(&*event);
    const files::ScannerPlan* plan = scan != nullptr ? plan_of(*scan, built.scanners) : nullptr;
    if (plan == nullptr) continue;
    scan->scanner.sweep_s = result.sweep_s;
    built.scans.push_back({scan->stamp_ns, scan->range_m.size(), plan->name});
    model.add(*scan, *plan->profile_mounting);
  }
  built.model = model.finish();
  built.faults = log->faults();
  if (built.model.counts.scans == built.model.counts.scans_without_pose)
    return Error{input.log.string() +
                 ": no vertical scan within the trajectory of the result: not the log of that run"};
  return built;
}

}  // namespace slammot
