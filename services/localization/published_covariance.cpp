#include "services/localization/published_covariance.hpp"

#include <cmath>

namespace slammot::localization {
namespace {

constexpr double kVarianceMemory_s = 2.0;  // Over which published covariances are fitted to the
                                           // surprises seen.
constexpr double kComparedOver_s = 1.0;  // Published covariances are to be honest about the motion
                                         // over this time.

}  // namespace

void PublishedCovariance::observe(const Step& step, const ScanMatch& match) {
  if (match.is_believed) {
    // What scans of several scanners at the same time say of each other counts as if one came a
    // usual step later.
    const double apart_s = step.duration_s > 0.0 ? step.duration_s : step.usual_duration_s;
    const double share = 1.0 - std::exp(-apart_s / kVarianceMemory_s);
    state_.factors = sensing::learned(state_.factors, step.prior(), match.odom_from_base, share);
    state_.map_change.squared_residuals =
        std::pow(match.rms_residual_m / config_.echoes.range_noise_m, 2);
  }
  state_.factors = sensing::carried(state_.factors, step.odom_from_base_before, step.prior(),
                                    match.odom_from_base);
  const double now = step.source == StepSource::kVelocityAlone ? 1.0 : 0.0;
  state_.by_scans_alone +=
      (1.0 - std::exp(-step.duration_s / kComparedOver_s)) * (now - state_.by_scans_alone);
  const geometry::Pose2 before_from_base = matched_step(step, match);
  const double moved_m = std::hypot(before_from_base.x_m, before_from_base.y_m);
  state_.map_change.way_m =
      std::exp(-step.duration_s / kComparedOver_s) * state_.map_change.way_m + moved_m;
}

PublishedPose PublishedCovariance::published(const sensing::MotionEstimate& estimate,
                                             bool is_lost) const {
  const sensing::VarianceFactors factors =
      sensing::published(state_.factors, config_.errors.pose_errors, state_.map_change);
  geometry::UncertainPose2 pose{estimate.odom_from_base,
                                sensing::scaled(estimate.uncertain_pose(), factors)};
  double share = share_with_wheels();
  pose.covariance /= share;
  if (is_lost) {
    const geometry::Matrix3 anywhere = config_.recovery.anywhere();
    const double known_m2 = pose.covariance.topLeftCorner<2, 2>().trace();
    share *= known_m2 / (known_m2 + anywhere.topLeftCorner<2, 2>().trace());
    pose.covariance += anywhere;
  }
  return {pose, share};
}

double PublishedCovariance::share_with_wheels() const {
  return 1.0 / (1.0 + (config_.errors.variance_by_scans_alone - 1.0) * state_.by_scans_alone);
}

}  // namespace slammot::localization
