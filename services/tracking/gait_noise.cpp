#include "services/tracking/gait_noise.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {

double gait_variance_m2(double after_s, const TrackingConfig& config) {
  const double kept = std::exp(-after_s / kGaitMemoryS);
  return gait_sigma_m(config) * gait_sigma_m(config) * (1.0 + kept) / (1.0 - kept);
}

GaitNoise with_step(const GaitNoise& before, const Eigen::Vector2d& innovation_m,
                    const Eigen::Matrix2d& noise_m2, double time_s, const TrackingConfig& config) {
  constexpr double kMemoryS = 1.5;    // a few steps
  constexpr double kMostShare = 9.0;  // a larger error is not a pedestrian's
  const double least_share = only_people_move(config) ? 1.0 : 0.125;  // legs move as configured; of
                                                                      // a coat the arms still do
  const double usual_m2 = gait_sigma_m(config) * gait_sigma_m(config);
  const double was_m2 = before.variance_m2.value_or(usual_m2);
  const double seen_m2 = std::min(0.5 * (innovation_m.squaredNorm() - noise_m2.trace()),
                                  4.0 * kMostShare * usual_m2);  // limits single outliers
  const double now_m2 = was_m2 + (1.0 - std::exp(-time_s / kMemoryS)) * (seen_m2 - was_m2);
  return {std::clamp(now_m2, least_share * usual_m2, kMostShare * usual_m2)};
}

double gait_share(const GaitNoise& gait, const RoadUsers& road_users,
                  const TrackingConfig& config) {
  return gait.variance_m2 ? std::sqrt(*gait.variance_m2) / gait_sigma_m(config)
                          : road_users.swing_share;
}

}  // namespace slammot::tracking
