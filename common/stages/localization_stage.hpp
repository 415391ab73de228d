#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/localized_scan.hpp"
#include "common/flow/scan_labels.hpp"
#include "common/flow/submap.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/sensing/aids.hpp"
#include "common/sensing/odometry_episodes.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::stages {

/// Scans and odometry in; pose, expected beams and submaps out. The pipeline's configuration
/// selects the implementation (services/slammot/implementations.hpp). An implementation is
/// deterministic, reads no clock and starts no thread. What has a default here is optional: an
/// implementation without it loses the feature that the comment names.
class LocalizationStage {
 public:
  virtual ~LocalizationStage() = default;

  virtual void add_odometry(const sensing::Odometry& sample) = 0;

  /// Pose of the scan in odom, its points without the motion of the sweep, and what the map
  /// expected of each beam. None for a scan that is dropped (a duplicate, or older than its
  /// predecessor). workspace: an earlier result of which only the memory is reused.
  virtual std::optional<flow::LocalizedScan> localize(const sensing::LaserScan& scan,
                                                      flow::LocalizedScan workspace) = 0;

  /// Labels of a localized scan, by tracking: which points go into the SO-map and which into the
  /// MO-map. They may come late or never.
  virtual void integrate(const flow::ScanLabels& labels) = 0;

  /// A submap that was finished since the last call, ids ascending from 0 without gaps.
  virtual std::optional<flow::Submap> take_finished_submap() = 0;

  /// End of the drive: integrates all scans that wait for labels and finishes the submap in
  /// progress.
  virtual void finish() = 0;

  /// Loop closing's latest correction: its map_from_odom holds from the next scan on.
  virtual void correct(const flow::GraphCorrection& correction) = 0;

  /// Counters for the report, by name; none ever falls.
  virtual std::map<std::string, std::uint64_t> named_counters() const = 0;

  /// Optional, for --iterations: matches the last scan again without the points that the labels
  /// call moving; none: the first match stays.
  virtual std::optional<flow::LocalizedScan> localize_again(const sensing::LaserScan&,
                                                            const std::vector<flow::PointLabel>&) {
    return std::nullopt;
  }

  /// Optional: absolute measurements, which the finished submaps carry to loop closing.
  virtual void add_fix(const sensing::GnssFix&) {}
  virtual void add_heading(const sensing::CompassReading&) {}

  /// Optional: tracks, as predictions of where moving objects are in the next scan.
  virtual void expect(const flow::TrackedObjects&) {}

  /// Optional, for --map: the last submap of the stored map that this drive continues.
  virtual void go_on_after(const flow::CorrectedSubmap&) {}

  /// Optional: true while the vehicle's place in the local map is not known.
  virtual bool is_lost() const { return false; }

  /// Optional: number of maps begun because the vehicle was lost for good.
  virtual std::uint64_t maps_begun_astray() const { return 0; }

  /// Optional: verdict about the odometry of the drive; none: the report says nothing about it.
  virtual std::optional<sensing::OdometryConclusions> verdict_on_odometry() const {
    return std::nullopt;
  }
};

}  // namespace slammot::stages
