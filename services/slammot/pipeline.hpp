#pragma once

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
#include "services/detection/detector.hpp"
#include "services/loop_closing/loop_closer.hpp"
#include "services/slammot/profile.hpp"
#include "services/slammot/side_thread.hpp"
#include "services/slammot/stage_times.hpp"

namespace slammot {

/// All stages in one process: what goes over the bus between the services is handed on by value, in
/// the same order every time.
class Pipeline {
 public:
  /// Localization and tracking are those that the profile names; it must name such as there are
  /// (find_fault()). With more than one iteration what detection finds to move is left out and the
  /// scan matched and looked at again, so many times at most: Iterated SLAM with DATMO, Wang 2004,
  /// Section 6.2.
  explicit Pipeline(const Profile& profile, int iterations = 1);

  /// Before the first scan: submaps of earlier drives, ascending. The drive goes on in their map
  /// once it has found itself in it; the record holds them, too.
  void go_on_in(const std::vector<flow::Submap>& stored);

  void take(const sensing::Odometry& odometry);

  /// Localizes, detects, tracks and maps one scan, and closes loops when that finished a submap.
  void take(const sensing::LaserScan& scan);

  /// At the end of the drive: the submap in progress ends, too.
  void finish();

  const files::RunRecord& record() const { return record_; }
  const StageTimes& times() const { return times_; }
  std::map<std::string, std::map<std::string, std::uint64_t>> counters() const;

  /// Whether the last scan did not match the map.
  bool is_lost() const { return localizer_->is_lost(); }

  /// Parts of the map begun because the drive was lost for good.
  std::uint64_t maps_begun() const { return localizer_->maps_begun_astray(); }

  std::optional<sensing::OdometryConclusions> verdict_on_odometry() const {
    return localizer_->verdict_on_odometry();
  }

  /// Whether the newest finished submap is tied to the first one of the map.
  bool is_connected() const { return loop_closer_.is_connected(); }

 private:
  /// A scan with the pose by which it was segmented.
  struct Detected {
    flow::LocalizedScan localized;
    flow::SegmentedScan segmented;
  };

  std::optional<Detected> localize_and_detect(const sensing::LaserScan& scan);
  Detected iterate(const sensing::LaserScan& scan, Detected first);
  void close_loops();

  SideThread side_thread_;  ///< Before what it helps.
  detection::Detector detector_;
  std::unique_ptr<stages::LocalizationStage> localizer_;
  std::unique_ptr<stages::TrackingStage> tracker_;
  loop_closing::LoopCloser loop_closer_;
  flow::LocalizedScan localized_done_with_;  ///< Memory for the next one,
  flow::SegmentedScan segmented_done_with_;  ///< and so.
  files::RunRecord record_;
  StageTimes times_;
  int iterations_;
  std::uint64_t scans_iterated_ = 0;  ///< Whose pose is not that of the first match,
  std::uint64_t matches_again_ = 0;   ///< and after how many more in all.
};

}  // namespace slammot
