#include "common/files/odometry_agreement.hpp"

#include <cmath>

#include "common/files/pose_difference.hpp"

namespace slammot::files {

void OdometryAgreement::add_odom(const sensing::Odometry& odom) {
  constexpr double kMetM = 0.10;
  constexpr double kMetRad = 0.10;
  for (const sensing::Odometry& laser : waiting_) {
    if (!before_ || laser.stamp_ns < before_->stamp_ns || laser.stamp_ns > odom.stamp_ns) continue;
    const double span_ns = static_cast<double>(odom.stamp_ns - before_->stamp_ns);
    const double fraction =
        span_ns > 0.0 ? static_cast<double>(laser.stamp_ns - before_->stamp_ns) / span_ns : 0.0;
    ++compared_;
    // Interpolation can be wrong by the motion between the two ODOM lines.
    const double slack_m = kMetM + 0.5 * distance_m(before_->wheel_from_base, odom.wheel_from_base);
    const double slack_rad =
        kMetRad + 0.5 * std::abs(geometry::wrap_angle(odom.wheel_from_base.heading_rad -
                                                      before_->wheel_from_base.heading_rad));
    if (!differ(geometry::interpolate(before_->wheel_from_base, odom.wheel_from_base, fraction),
                laser.wheel_from_base, slack_m, slack_rad))
      ++met_;
  }
  waiting_.clear();
  before_ = odom;
}

void OdometryAgreement::add_laser(const sensing::Odometry& laser) {
  constexpr std::size_t kMaxWaiting = 64;
  if (waiting_.size() < kMaxWaiting) waiting_.push_back(laser);
}

bool OdometryAgreement::agrees() const {
  constexpr double kMetShare = 0.95;
  return compared_ > 0 && static_cast<double>(met_) >= kMetShare * static_cast<double>(compared_);
}

}  // namespace slammot::files
