#pragma once

#include "common/sensing/variance_factor.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_match.hpp"

namespace slammot::localization {

/// Fits the covariance that is published to the surprises that matches show. It changes no
/// estimate.
class PublishedCovariance {
 public:
  struct State {
    sensing::VarianceFactors factors;
    sensing::MapChange map_change;
    double by_scans_alone = 0.0;  ///< Share of the time over which poses are compared that had no
                                  ///< wheels.
  };

  explicit PublishedCovariance(const LocalizerConfig& config) : config_(config) {}

  /// One more scan with its prediction and its match.
  void observe(const Step& step, const ScanMatch& match);

  /// The pose of an estimate with the covariance to publish; 3x3 over (x [m], y [m], heading [rad])
  /// in odom.
  geometry::UncertainPose2 published(const sensing::MotionEstimate& estimate) const;

  /// Of what is published, what the pose may be off within the local map. Where scans alone tell,
  /// map and pose drift together.
  double local_variance_share() const;

  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  LocalizerConfig config_;
  State state_;
};

}  // namespace slammot::localization
