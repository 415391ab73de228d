#pragma once

#include "common/sensing/variance_factor.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_match.hpp"

namespace slammot::localization {

struct PublishedPose {
  geometry::UncertainPose2 odom_from_base;
  double local_variance_share = 1.0;  ///< Of the covariance, what the pose may be off within the
                                      ///< local map.

  geometry::UncertainPose2 within_local_map() const {
    return {odom_from_base.pose, local_variance_share * odom_from_base.covariance};
  }
};

/// Fits the covariance that is published to the surprises that matches show. It changes no
/// estimate.
class PublishedCovariance {
 public:
  struct State {
    sensing::VarianceFactors factors;
    sensing::MapChange map_change;
    double by_scans_alone = 0.0;  ///< Share of the time over which poses are compared that had no
                                  ///< wheels, or none that are believed.
  };

  explicit PublishedCovariance(const LocalizerConfig& config) : config_(config) {}

  /// One more scan with its prediction and its match.
  void observe(const Step& step, const ScanMatch& match);

  /// The pose of an estimate with the covariance to publish; 3x3 over (x [m], y [m], heading [rad])
  /// in odom. Where scans alone tell, map and pose drift together. A vehicle that is lost may be
  /// anywhere; what it sees now it still sees at places known to each other.
  PublishedPose published(const sensing::MotionEstimate& estimate, bool is_lost) const;

  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  double share_with_wheels() const;

  LocalizerConfig config_;
  State state_;
};

}  // namespace slammot::localization
