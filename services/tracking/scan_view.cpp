#include "services/tracking/scan_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using geometry::wrap_angle;

std::array<Vector2d, 4> corners_of(const Footprint& footprint, const Vector2d& centre_m,
                                   double margin_m) {
  const Vector2d along = (0.5 * footprint.length.value_m + margin_m) *
                         Vector2d(std::cos(footprint.heading_rad), std::sin(footprint.heading_rad));
  const Vector2d across =
      (0.5 * footprint.width.value_m + margin_m) *
      Vector2d(-std::sin(footprint.heading_rad), std::cos(footprint.heading_rad));
  return {centre_m + along + across, centre_m + along - across, centre_m - along - across,
          centre_m - along + across};
}

}  // namespace

void ScanView::look_at(const flow::SegmentedScan& scan) {
  scan_ = &scan;
  polar_.look_at(scan);
  segment_of_beam_.assign(scan.range_m.size(), kNone);
  for (std::size_t segment = 0; segment < scan.segments.size(); ++segment)
    for (const std::uint16_t beam : scan.segments[segment].beams) segment_of_beam_[beam] = segment;
}

ScanView::Directions ScanView::directions_of(const Footprint& footprint, const Vector2d& centre_m,
                                             double margin_m) const {
  const Vector2d to_centre_m = centre_m - laser_in_odom_m();
  const double middle_rad = std::atan2(to_centre_m.y(), to_centre_m.x());
  const double middle = polar_.steps_towards(middle_rad);
  const double sense = scan_->beam_step_rad < 0.0 ? -1.0 : 1.0;
  double low = middle;
  double high = middle;
  for (const Vector2d& corner : corners_of(footprint, centre_m, margin_m)) {
    const Vector2d way = corner - laser_in_odom_m();
    const double steps =
        middle + sense * wrap_angle(std::atan2(way.y(), way.x()) - middle_rad) / beam_step_rad();
    low = std::min(low, steps), high = std::max(high, steps);
  }
  if (!std::isfinite(low) || !std::isfinite(high)) return {};  // nowhere, or of no size
  const auto count = static_cast<double>(scan_->range_m.size());
  double first = std::ceil(low - 0.5);
  double last = std::floor(high + 0.5) + 1.0;
  if (polar_.goes_all_round())
    return {*polar_.neighbour_of(0, std::lround(first)),
            static_cast<std::size_t>(std::min(last - first, count))};
  if (high < 0.0 || low > count) return {};
  first = std::clamp(first, 0.0, count), last = std::clamp(last, first, count);
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(last - first)};
}

Visibility ScanView::visibility_of(const Footprint& footprint, const Vector2d& centre_m) const {
  constexpr double kMarginM = 0.3;
  const Directions directions = directions_of(footprint, centre_m, 0.0);
  double nearest_m = 1e9;
  double farthest_m = 0.0;
  for (const Vector2d& corner : corners_of(footprint, centre_m, 0.0)) {
    const double range_m = (corner - laser_in_odom_m()).norm();
    nearest_m = std::min(nearest_m, range_m), farthest_m = std::max(farthest_m, range_m);
  }
  Visibility visibility;
  for (std::size_t i = 0; i < directions.count; ++i) {
    ++visibility.beams;
    const auto range_m =
        polar_.range_m(*polar_.neighbour_of(directions.first, static_cast<long>(i)));
    if (range_m > 0.0 && range_m < nearest_m - kMarginM) ++visibility.blocked;
    if (range_m > farthest_m + kMarginM) ++visibility.passed;
    if (range_m <= 0.0) ++visibility.unanswered;
  }
  return visibility;
}

Edge edge_beyond(const ScanView& view, std::size_t beam, int step, double size_scale) {
  constexpr int kBeamsLookedAt = 2;
  constexpr double kFartherM = 0.5;
  const auto stands = [&](std::size_t neighbour) {
    const std::size_t segment = view.segment_of_beam(neighbour);
    return segment == ScanView::kNone ||
           view.scan().segments[segment].label == flow::PointLabel::kStationary;
  };
  Edge edge = Edge::kNoEcho;
  for (int i = 1; i <= kBeamsLookedAt; ++i) {
    const std::optional<std::size_t> neighbour = view.polar().neighbour_of(beam, i * step);
    if (!neighbour) return Edge::kHidden;
    const double range_m = view.polar().range_m(*neighbour);
    if (range_m <= 0.0) continue;
    const double farther_m = range_m - view.polar().range_m(beam);
    if (farther_m < -kFartherM * size_scale ||
        (farther_m < kFartherM * size_scale && !stands(*neighbour)))
      return Edge::kHidden;
    edge = Edge::kOpen;
  }
  return edge;
}

}  // namespace slammot::tracking
