#include "services/tracking/scan_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using geometry::wrap_angle;

std::array<Vector2d, 4> corners_of(const Body& body, const Vector2d& centre_m, double margin_m) {
  const Vector2d along = (0.5 * body.length.value_m + margin_m) * Vector2d(std::cos(body.heading_rad), std::sin(body.heading_rad));
  const Vector2d across = (0.5 * body.width.value_m + margin_m) * Vector2d(-std::sin(body.heading_rad), std::cos(body.heading_rad));
  return {centre_m + along + across, centre_m + along - across, centre_m - along - across, centre_m - along + across};
}

}  // namespace

ScanView::ScanView(const flow::SegmentedScan& scan)
    : scan_(&scan),
      laser_in_odom_m_(scan.odom_from_base.pose * scan.base_from_laser.translation_m()),
      beam_step_rad_(std::abs(scan.beam_step_rad)),
      is_clockwise_(scan.beam_step_rad < 0.0) {
  const Eigen::Matrix2d R = geometry::rotation(scan.odom_from_base.pose.heading_rad);
  const Vector2d t = scan.odom_from_base.pose.translation_m();
  points_in_odom_m_.resize(scan.range_m.size());
  segment_of_beam_.assign(scan.range_m.size(), kNone);
  bool knows_direction = false;
  for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam) {
    points_in_odom_m_[beam] = R * scan.points_in_base_m[beam].cast<double>() + t;
    if (knows_direction || scan.range_m[beam] <= 0.0F) continue;
    // The scan does not carry its first beam's direction; the first echo tells it, to what the sweep's motion moved it.
    const Vector2d way = points_in_odom_m_[beam] - laser_in_odom_m_;
    first_beam_in_odom_rad_ = std::atan2(way.y(), way.x()) - static_cast<double>(beam) * scan.beam_step_rad;
    knows_direction = true;
  }
  for (std::size_t segment = 0; segment < scan.segments.size(); ++segment)
    for (const std::uint16_t beam : scan.segments[segment].beams) segment_of_beam_[beam] = segment;
}

ScanView::Directions ScanView::directions_of(const Body& body, const Vector2d& centre_m, double margin_m) const {
  const Vector2d to_centre_m = centre_m - laser_in_odom_m_;
  const double middle_rad = std::atan2(to_centre_m.y(), to_centre_m.x());
  double low = 0.0;
  double high = 0.0;
  for (const Vector2d& corner : corners_of(body, centre_m, margin_m)) {
    const Vector2d way = corner - laser_in_odom_m_;
    const double off_rad = wrap_angle(std::atan2(way.y(), way.x()) - middle_rad);
    low = std::min(low, off_rad), high = std::max(high, off_rad);
  }
  const double turned = is_clockwise_ ? -1.0 : 1.0;
  // Sense of the scan; the middle is brought within half a turn of the middle of the field of view.
  const double half_view_rad = 0.5 * beam_step_rad_ * static_cast<double>(scan_->range_m.size());
  const double in_view_rad = half_view_rad + wrap_angle(turned * (middle_rad - first_beam_in_odom_rad_) - half_view_rad);
  const double from_rad = in_view_rad + (is_clockwise_ ? -high : low);
  const double to_rad = in_view_rad + (is_clockwise_ ? -low : high);
  const auto count = static_cast<double>(scan_->range_m.size());
  const double first = std::clamp(std::ceil(from_rad / beam_step_rad_ - 0.5), 0.0, count);
  const double last = std::clamp(std::floor(to_rad / beam_step_rad_ + 0.5) + 1.0, first, count);
  if (to_rad < 0.0 || from_rad > count * beam_step_rad_) return {};
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(last)};
}

Visibility ScanView::visibility_of(const Body& body, const Vector2d& centre_m) const {
  constexpr double kMarginM = 0.3;
  const Directions directions = directions_of(body, centre_m, 0.0);
  double nearest_m = 1e9;
  double farthest_m = 0.0;
  for (const Vector2d& corner : corners_of(body, centre_m, 0.0)) {
    const double range_m = (corner - laser_in_odom_m_).norm();
    nearest_m = std::min(nearest_m, range_m), farthest_m = std::max(farthest_m, range_m);
  }
  Visibility visibility;
  for (std::size_t beam = directions.first; beam < directions.last; ++beam) {
    ++visibility.beams;
    const auto range_m = static_cast<double>(scan_->range_m[beam]);
    if (range_m > 0.0 && range_m < nearest_m - kMarginM) ++visibility.blocked;
    if (range_m <= 0.0 || range_m > farthest_m + kMarginM) ++visibility.passed;
  }
  return visibility;
}

}  // namespace slammot::tracking
