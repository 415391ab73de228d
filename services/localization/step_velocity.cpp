#include "services/localization/step_velocity.hpp"

#include <algorithm>

#include "common/sensing/deskew.hpp"

namespace slammot::localization {

Step with_velocity(Step step, const OdometryPrediction::LastScan& last) {
  step.before_from_base =
      geometry::inverse(step.odom_from_base_before.pose) * step.after.odom_from_base;
  const bool is_later = step.duration_s > 0.0;
  step.speed_mps = is_later ? step.before_from_base.x_m / step.duration_s : last.speed_mps;
  step.yaw_rate_radps =
      is_later ? step.before_from_base.heading_rad / step.duration_s : last.yaw_rate_radps;
  if (!step.is_by_wheels()) return step;
  step.speed_mps += step.wheels.gained.x();
  step.yaw_rate_radps += step.wheels.gained.y();
  return step;
}

/// Zero where odometry does not reach so far. A vehicle that begins to turn while a scanner sweeps
/// slowly is not where the step before the scan leads.
sensing::Velocity OdometryPrediction::gained_in_sweep(const Step& step,
                                                      const geometry::Pose2& by_wheels,
                                                      double sweep_s) const {
  constexpr double kLeastFittingShare = 0.5;
  const std::optional<std::int64_t> newest_ns = odometry_.newest_ns();
  if (sweep_s < sensing::kSlowSweep_s || step.duration_s <= 0.0 || !newest_ns) return {0.0, 0.0};
  const double swept_s = std::min(sweep_s, 1e-9 * static_cast<double>(*newest_ns - step.stamp_ns));
  const auto at_end = swept_s >= kLeastFittingShare * sweep_s
                          ? wheel_from_base_at(step.stamp_ns + to_ns(swept_s))
                          : std::nullopt;
  if (!at_end) return {0.0, 0.0};
  const geometry::Pose2 swept = sensing::corrected(
      geometry::inverse(*step.wheels.wheel_from_base) * *at_end, swept_s, state_.belief.factors);
  return sensing::Velocity{swept.x_m, swept.heading_rad} / swept_s -
         sensing::Velocity{by_wheels.x_m, by_wheels.heading_rad} / step.duration_s;
}

}  // namespace slammot::localization
