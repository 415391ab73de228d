#pragma once

#include <optional>
#include <vector>

#include "common/grids/evidence_grid.hpp"
#include "common/sensing/odometry_episodes.hpp"
#include "common/sensing/scan.hpp"
#include "common/work/side_work.hpp"
#include "services/localization/checkpoint.hpp"
#include "services/localization/localization_monitor.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/localizer_counters.hpp"
#include "services/localization/mixture_match.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/odometry_watch.hpp"
#include "services/localization/pose_state.hpp"
#include "services/localization/published_covariance.hpp"
#include "services/localization/relocalization.hpp"
#include "services/localization/scan_integration.hpp"
#include "services/localization/scan_matcher.hpp"
#include "services/localization/scan_points.hpp"
#include "services/localization/submap_sequence.hpp"
#include "services/localization/sweep_correction.hpp"

namespace slammot::localization {

/// A scan with the map that it is placed in, which it may change: what was doubted goes into it
/// where the pose is confirmed, and another one begins where the vehicle has gone astray.
struct ScanToPlace {
  const sensing::LaserScan& scan;
  const std::vector<grids::Box>& masks;  ///< Objects in odom: not matched.
  SubmapSequence& submaps;
  ScanIntegration& integration;
  LocalizerCounters& counters;
};

/// Estimates the pose from scan to scan: odometry predicts it, the explanations of the step and the
/// match against the local map correct it, the monitor judges it, and a lost vehicle is searched
/// for.
class PoseEstimator {
 public:
  /// help, if any, takes over part of matching; it must outlive this.
  explicit PoseEstimator(const LocalizerConfig& config, work::SideWork* help = nullptr);

  void add(const sensing::Odometry& sample);

  /// Another scan follows: companion_beams end on what goes along with the vehicle (ascending).
  void begin_scan(const std::vector<std::size_t>& companion_beams) {
    points_.begin_scan(companion_beams);
  }
  /// It is the first one: its pose is the origin of odom.
  void begin(const sensing::LaserScan& scan);
  /// It comes after others: takes the estimate to it. False where its match is not believed.
  bool place(const ScanToPlace& placed);
  /// It was placed: what several scans tell of odometry is applied from the next one on. Whether
  /// there was anything.
  bool correct_odometry(const sensing::LaserScan& scan, LocalizerCounters& counters);

  /// From the next place() on leaves out the echoes that the labels, one a beam, keep out of the
  /// SO-map. False, and nothing changed, where these are left out already.
  bool leave_out(const std::vector<flow::PointLabel>& labels) { return points_.leave_out(labels); }

  const OdometryPrediction& prediction() const { return prediction_; }
  const geometry::Pose2& odom_from_base() const { return prediction_.estimate().odom_from_base; }
  const LocalizationMonitor& monitor() const { return monitor_; }
  const ScanPoints& points() const { return points_; }  ///< Of the scan at hand.
  /// What may become of the scan at hand.
  MapAdmission admission() const {
    return prediction_.state().slip.keeps_map_as_it_is() ? MapAdmission::kWithheld
                                                         : monitor_.admission();
  }
  const SweepCorrection& sweep() const { return sweep_; }
  PublishedPose published(const sensing::MotionEstimate& estimate) const {
    return covariance_.published(estimate, monitor_.is_lost());
  }
  /// Since the last resume().
  sensing::OdometryConclusions odometry_conclusions() const {
    return watch_.conclusions(prediction_);
  }

  PoseState state() const;
  void set_state(const PoseState& state);

  /// For a checkpoint.
  const KeyframeOdometry::State& keyframes() const { return watch_.keyframes(); }
  /// After a restart: goes on from a checkpoint, with the odometry of `before` that came for no
  /// scan yet.
  void resume(const Checkpoint& checkpoint, PoseEstimator&& before);

 private:
  void take_points(const ScanToPlace& placed, const Step& step);
  std::optional<ExplainedStep> explain_or_doubt(const ScanToPlace& placed, const Step& by_wheels);
  std::optional<ExplainedStep> explain(const ScanToPlace& placed, const Step& by_wheels);
  ScanMatch match_or_relocalize(const ScanToPlace& placed, const Step& step,
                                const matching::PointToLineResult* registered);
  std::optional<ScanMatch> relocalize(const ScanToPlace& placed, const Step& step);
  void learn(const ScanToPlace& placed, const Step& step, const ScanMatch& found);
  void begin_astray_map(const ScanToPlace& placed);

  LocalizerConfig config_;
  OdometryPrediction prediction_;
  SweepCorrection sweep_;
  ScanPoints points_;
  ScanMatcher matcher_;
  MixtureMatch mixture_;
  LocalizationMonitor monitor_;
  Relocalization relocalization_;
  PublishedCovariance covariance_;
  OdometryWatch watch_;
};

}  // namespace slammot::localization
