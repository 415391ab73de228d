#include "services/slammot/model_log.hpp"

#include <algorithm>
#include <cstdint>

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

/// Counts the scans of a log that a trajectory has a pose of. Trajectories hold whole microseconds.
class StampsInCommon {
 public:
  explicit StampsInCommon(const metrics::Trajectory& online) : online_(online) {}

  void add(std::int64_t stamp_ns) {
    constexpr std::int64_t kSame_ns = 1000;
    ++scans_;
    const auto pose =
        std::ranges::lower_bound(online_, stamp_ns - kSame_ns, {}, &metrics::StampedPose::stamp_ns);
    if (pose != online_.end() && pose->stamp_ns <= stamp_ns + kSame_ns) ++found_;
  }

  /// The log may be cut off, and a run may use some scanners of several or a part of the drive. A
  /// log without planar scans tells nothing.
  bool are_of_one_drive() const {
    return 2 * found_ >= std::min<std::size_t>(scans_, online_.size());
  }
  std::string described() const {
    return std::to_string(found_) + " of its " + std::to_string(scans_) +
           " planar scans are at the time of a pose of the result";
  }

 private:
  const metrics::Trajectory& online_;
  std::size_t scans_ = 0;
  std::size_t found_ = 0;
};

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
  StampsInCommon stamps(result.online);
  while (auto event = log->next()) {
    auto* scan = std::get_if<sensing::LaserScan>(&*event);
    if (scan == nullptr) continue;
    const files::ScannerPlan* plan = plan_of(*scan, built.scanners);
    if (plan == nullptr) {
      if (plan_of(*scan, log->plan().profile_scanners) == nullptr) stamps.add(scan->stamp_ns);
      continue;
    }
    scan->scanner.sweep_s = result.sweep_s;
    built.scans.push_back({scan->stamp_ns, scan->range_m.size(), plan->name});
    model.add(*scan, *plan->profile_mounting);
  }
  built.model = model.finish();
  built.faults = log->faults();
  if (built.model.counts.scans == built.model.counts.scans_without_pose)
    return Error{input.log.string() +
                 ": no vertical scan within the trajectory of the result: not the log of that run"};
  if (!stamps.are_of_one_drive())
    return Error{input.log.string() + ": " + stamps.described() + ": not the log of that run"};
  return built;
}

}  // namespace slammot
