#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/files/run_record.hpp"
#include "common/sensing/scan.hpp"
#include "common/stages/localization_stage.hpp"
#include "common/stages/tracking_stage.hpp"
#include "common/traffic/submap_traffic.hpp"
#include "services/detection/detector.hpp"
#include "services/loop_closing/loop_closer.hpp"
#include "services/slammot/profile.hpp"
#include "services/slammot/side_thread.hpp"
#include "services/slammot/stage_times.hpp"

namespace slammot {

/// All stages in one process. Data is passed by value and in a fixed order, so that the results are
/// reproducible.
class Pipeline {
 public:
  /// Uses the implementations that the profile names; precondition: find_fault() is empty. With
  /// more than one iteration, each scan is matched and segmented again without moving points, at
  /// most so many times: iterated SLAM with DATMO, Wang 2004, section 6.2.
  explicit Pipeline(const Profile& profile, int iterations = 1);

  /// Call before the first scan, with the submaps of earlier drives in ascending order. Once loop
  /// closing has located the drive, it continues in their map. The record contains them, too.
  void continue_map(const std::vector<flow::Submap>& stored);

  void take(const sensing::Odometry& odometry);
  void take(const sensing::GnssFix& fix) { localizer_->add_fix(fix); }
  void take(const sensing::CompassReading& reading) { localizer_->add_heading(reading); }

  /// Localizes, segments, tracks and maps one scan, and closes loops if it finished a submap.
  void take(const sensing::LaserScan& scan);

  /// Call at the end of the drive: finishes the current submap.
  void finish();

  const files::RunRecord& record() const { return record_; }
  const StageTimes& times() const { return times_; }

  /// What moved during this drive; that of a submap is complete when the submap is finished.
  const traffic::SubmapTraffic& traffic() const { return traffic_.by_submap(); }
  std::map<std::string, std::map<std::string, std::uint64_t>> counters() const;

  /// True if the last scan did not match the map.
  bool is_lost() const { return localizer_->is_lost(); }

  /// Closures in the graph now.
  std::size_t accepted_closures() const;

  /// New parts of the map begun after permanent losses.
  std::uint64_t maps_begun() const { return localizer_->maps_begun_astray(); }

  std::optional<sensing::OdometryConclusions> verdict_on_odometry() const {
    return localizer_->verdict_on_odometry();
  }

  /// True if the newest finished submap is connected to the first one of the map.
  bool is_connected() const { return loop_closer_.is_connected(); }

 private:
  /// A scan with the pose that was used to segment it.
  struct Detected {
    flow::LocalizedScan localized;
    flow::SegmentedScan segmented;
  };

  std::optional<Detected> localize_and_detect(const sensing::LaserScan& scan);
  Detected iterate(const sensing::LaserScan& scan, Detected first);
  void close_loops();

  SideThread side_thread_;  ///< Declared before the stages that use it.
  detection::Detector detector_;
  std::unique_ptr<stages::LocalizationStage> localizer_;
  std::unique_ptr<stages::TrackingStage> tracker_;
  loop_closing::LoopCloser loop_closer_;
  flow::LocalizedScan recycled_localized_;  ///< Its memory is reused.
  flow::SegmentedScan recycled_segmented_;  ///< Its memory is reused.
  files::RunRecord record_;
  traffic::TrafficOfDrive traffic_;
  StageTimes times_;
  int iterations_;
  std::uint64_t scans_iterated_ = 0;  ///< Scans matched more than once.
  std::uint64_t matches_again_ = 0;   ///< Total number of additional matches.
};

}  // namespace slammot
