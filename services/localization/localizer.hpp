#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/localized_scan.hpp"
#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/flow/submap.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/sensing/odometry_episodes.hpp"
#include "common/sensing/scan.hpp"
#include "common/stages/localization_stage.hpp"
#include "common/work/side_work.hpp"
#include "services/localization/checkpoint.hpp"
#include "services/localization/expected_objects.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/localizer_counters.hpp"
#include "services/localization/pose_estimator.hpp"
#include "services/localization/scan_description.hpp"
#include "services/localization/scan_intake.hpp"
#include "services/localization/scan_integration.hpp"
#include "services/localization/submap_sequence.hpp"

namespace slammot::localization {

/// Estimates the pose of the vehicle and the map around it, scan by scan: passes each scan through
/// the parts below, in their order, and counts what they say. Not thread-safe; reads no clock.
class Localizer final : public stages::LocalizationStage {
 public:
  /// help, if any, does what the next match does not need, which is most of mapping, and half of
  /// the polar view. The results are the same with it and without. It must outlive this.
  explicit Localizer(const LocalizerConfig& config, work::SideWork* help = nullptr);

  void add_odometry(const sensing::Odometry& sample) override { estimator_.add(sample); }

  void add_fix(const sensing::GnssFix& fix) override { submaps_.measurements().add(fix); }
  void add_heading(const sensing::CompassReading& reading) override {
    submaps_.measurements().add(reading);
  }

  /// Whether waiting for more odometry could still improve the prediction at the stamp.
  bool has_odometry_for(std::int64_t stamp_ns) const { return prediction().reaches(stamp_ns); }

  /// Pose of the scan, its points without the sweep's motion, and what the map expected of each
  /// beam. None for a scan that is a duplicate (of the same scanner and stamp), out of order, or
  /// far ahead of all before it. Remembers the scan until its labels come. workspace is memory for
  /// the result: any earlier one that nobody needs any more.
  std::optional<flow::LocalizedScan> localize(const sensing::LaserScan& scan,
                                              flow::LocalizedScan workspace = {}) override;

  /// The scan that was localized last, matched once more from the same prediction and against the
  /// same map, without the points that its labels keep out of the SO-map; in place of what was
  /// remembered of it. Iterated SLAM with DATMO of Wang 2004, Section 6.2. None, and nothing
  /// changed, where that cannot be or cannot be better: the labels leave out the same points as
  /// before or too many for a match that is believed, it is the first scan, the vehicle is or was
  /// lost, it has been integrated, or another came since.
  std::optional<flow::LocalizedScan> localize_again(
      const sensing::LaserScan& scan, const std::vector<flow::PointLabel>& labels) override;

  /// What tracking says to be there: left out of the next matches. Where one that surely moves is
  /// in the scan of which the labels come next nothing stands.
  void expect(const flow::TrackedObjects& objects) override { expected_.expect(objects); }

  /// Labels by detection, used when tracking's do not come.
  void note(const flow::SegmentedScan& segmented) { integration_.note(segmented); }

  /// Whether a scan waits to be integrated.
  bool awaits_labels() const { return integration_.awaits_labels(); }

  /// Adds the scan, and any that still wait before it, to the maps. Unknown scans are ignored.
  void integrate(const flow::ScanLabels& labels) override;

  /// Submap that was finished since the last call.
  std::optional<flow::Submap> take_finished_submap() override { return submaps_.take_finished(); }

  /// Integrates what still waits and ends the submap in progress, as at the end of a drive. Should
  /// the drive go on, the next scan begins the next submap.
  void finish() override;

  void correct(const flow::GraphCorrection& correction) override { submaps_.correct(correction); }

  /// Goes on in a stored map: the drive's first submap follows the map's last one and is tied to it
  /// by next to nothing. Loop closing looks for where it lies; until then poses in map begin where
  /// that last one is. To be told again, as the map comes to be known, until the first scan; later
  /// it changes nothing.
  void go_on_after(const flow::CorrectedSubmap& last) override;

  /// Whether scans fit the local map, or its place in it is looked for.
  bool is_lost() const override { return estimator_.monitor().is_lost(); }

  const geometry::Pose2& map_from_odom() const { return submaps_.map_from_odom(); }
  const sensing::MotionCalibration& calibration() const {
    return prediction().estimate().calibration;
  }
  /// By how much later than the scans odometry is stamped, as believed, and whether that is certain
  /// enough to be used.
  double stamp_offset_s() const { return prediction().stamp_offset_s(); }
  double stamp_offset_sigma_s() const { return prediction().stamp_offset_sigma_s(); }
  bool applies_stamp_offset() const { return prediction().state().applies_stamp_offset; }
  /// What was concluded of odometry so far; since the last restore().
  sensing::OdometryConclusions odometry_conclusions() const {
    return estimator_.odometry_conclusions();
  }
  std::optional<sensing::OdometryConclusions> verdict_on_odometry() const override {
    return odometry_conclusions();
  }
  /// The floor in a scanner's view that was found with the scan that was localized last.
  const std::optional<sensing::FloorInView>& floor_found_now() const {
    return intake_.floor().found_now();
  }
  const SweepFactor& sweep_factor() const { return estimator_.sweep().factor(); }
  const LocalizerCounters& counters() const { return counters_; }
  std::map<std::string, std::uint64_t> named_counters() const override { return named(counters_); }
  std::uint64_t maps_begun_astray() const override { return counters_.map.astray; }
  const LocalMap& local_map() const { return submaps_.map(); }

  /// Everything that is needed to go on after a crash; none before the first scan. Scans that wait
  /// for their labels, and what tracking expects, are not in it. memory: of any earlier snapshot.
  std::optional<LocalizerSnapshot> snapshot(LocalMap::Snapshot memory = {}) const;
  /// The same as bytes in a form of this build; empty before the first scan.
  std::vector<std::byte> checkpoint() const;
  /// Odometry that came before the first scan is kept. False, and nothing changed, when the bytes
  /// are damaged or the map in them has another shape than this configuration's.
  bool restore(std::span<const std::byte> bytes);

 private:
  /// What a scan changes when it is localized: all that must be as before to do it again.
  struct Progress {
    PoseState estimate;
    SubmapSequence::Travel travelled;
    LocalizerCounters counters;
    std::uint64_t integrated_scans = 0;  ///< With more in the map, it is another one.
  };

  struct EstimateAtScan {
    const sensing::MotionEstimate& estimate;
    double speed_mps;
    double yaw_rate_radps;
  };

  const OdometryPrediction& prediction() const { return estimator_.prediction(); }
  PoseTrust trust() const { return estimator_.monitor().trust(); }
  Progress progress() const;
  void return_to(const Progress& progress);
  flow::LocalizedScan localize_in_order(const sensing::LaserScan& scan,
                                        flow::LocalizedScan workspace);
  std::optional<flow::LocalizedScan> predict_blank(const sensing::LaserScan& scan,
                                                   flow::LocalizedScan workspace);
  void begin(const sensing::LaserScan& scan);
  void place_next(const sensing::LaserScan& scan);
  bool place(const sensing::LaserScan& scan);
  bool can_be_placed_again(const sensing::LaserScan& scan,
                           const std::vector<flow::PointLabel>& labels) const;
  flow::LocalizedScan describe_placed(const sensing::LaserScan& scan,
                                      flow::LocalizedScan workspace);
  flow::LocalizedScan describe_and_remember(const sensing::LaserScan& scan,
                                            const EstimateAtScan& now, MapAdmission admission,
                                            flow::LocalizedScan workspace);
  Checkpoint checkpoint_now() const;
  void resume(RestoredCheckpoint restored, PoseEstimator&& before);

  LocalizerConfig config_;
  ScanIntake intake_;
  ExpectedObjects expected_;
  PoseEstimator estimator_;
  SubmapSequence submaps_;
  ScanDescription description_;
  ScanIntegration integration_;
  LocalizerCounters counters_;
  std::optional<Progress> before_scan_;  ///< Before the last one, while it may be localized again.
};

}  // namespace slammot::localization
