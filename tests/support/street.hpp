#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "common/flow/localized_scan.hpp"

namespace slammot::testing {

/// A box that stands or moves in odom.
struct StreetBox {
  geometry::Pose2 odom_from_box;
  double length_m = 4.5;
  double width_m = 1.8;
  geometry::Vector2 velocity_mps = geometry::Vector2::Zero();  ///< In odom, while a scan sweeps.
};

/// Range along the ray to the box so long after the scan's stamp; none where it misses.
inline std::optional<double> range_to(const StreetBox& box, const geometry::Vector2& origin_m,
                                      double direction_rad, double delay_s = 0.0) {
  const geometry::Vector2 centre_m = box.odom_from_box.translation_m() + delay_s * box.velocity_mps;
  const geometry::Pose2 box_from_odom =
      geometry::inverse(geometry::Pose2{centre_m.x(), centre_m.y(), box.odom_from_box.heading_rad});
  const geometry::Vector2 o = box_from_odom * origin_m;
  const double angle = direction_rad + box_from_odom.heading_rad;
  const geometry::Vector2 d{std::cos(angle), std::sin(angle)};
  double near = 0.0;
  double far = std::numeric_limits<double>::max();
  const double half[2] = {0.5 * box.length_m, 0.5 * box.width_m};
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(d[axis]) < 1e-12) {
      if (std::abs(o[axis]) > half[axis]) return std::nullopt;
      continue;
    }
    const double a = (-half[axis] - o[axis]) / d[axis];
    const double b = (half[axis] - o[axis]) / d[axis];
    near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
  }
  return near < far && near > 0.0 ? std::optional(near) : std::nullopt;
}

/// A scanner, of half a circle unless told, at the origin of base, among boxes of which the map
/// knows some. Everything in front of what it expects is known to be free.
struct Street {
  std::vector<StreetBox> known;    ///< Standing, in the map.
  std::vector<StreetBox> unknown;  ///< Not in the map: whatever moves.
  std::vector<StreetBox> gone;     ///< In the map, but no longer there.
  bool knows_the_open = true;      ///< Whether the map knows what is free where it expects nothing.
  int beams = 361;
  double first_beam_rad = -0.5 * M_PI;
  double field_of_view_rad = M_PI;
  double max_range_m = 80.0;
  double sweep_s = 0.0;

  static double nearest(const std::vector<StreetBox>& boxes, const geometry::Vector2& origin_m,
                        double direction_rad, double max_range_m, double delay_s) {
    double range_m = max_range_m;
    for (const StreetBox& box : boxes)
      if (const auto hit = range_to(box, origin_m, direction_rad, delay_s))
        range_m = std::min(range_m, *hit);
    return range_m;
  }

  flow::LocalizedScan scan(std::int64_t stamp_ns, std::uint32_t sequence,
                           const geometry::Pose2& odom_from_base = {}) const {
    flow::LocalizedScan scan;
    scan.stamp_ns = stamp_ns;
    scan.sequence = sequence;
    scan.scanner_id = "front";
    scan.max_range_m = max_range_m;
    scan.beam_step_rad = field_of_view_rad / (beams - 1);
    scan.sweep_s = sweep_s;
    scan.odom_from_base.pose = odom_from_base;
    scan.odom_from_base.covariance.diagonal() << 1e-4, 1e-4, 1e-6;
    for (int i = 0; i < beams; ++i) {
      const double in_base_rad = first_beam_rad + i * scan.beam_step_rad;
      const double in_odom_rad = in_base_rad + odom_from_base.heading_rad;
      const geometry::Vector2 origin_m = odom_from_base.translation_m();
      const double delay_s = sweep_s * i / (beams - 1);
      const double known_m = nearest(known, origin_m, in_odom_rad, max_range_m, delay_s);
      const double unknown_m = nearest(unknown, origin_m, in_odom_rad, max_range_m, delay_s);
      const double expected_m =
          std::min(known_m, nearest(gone, origin_m, in_odom_rad, max_range_m, delay_s));
      flow::LocalizedBeam beam;
      const double range_m = std::min(known_m, unknown_m);
      beam.expected_range_m = static_cast<float>(expected_m);
      beam.point_in_base_m =
          (range_m * Eigen::Vector2d(std::cos(in_base_rad), std::sin(in_base_rad))).cast<float>();
      if (range_m < max_range_m) {
        beam.range_m = static_cast<float>(range_m);
        const bool is_known = knows_the_open || expected_m < max_range_m;
        const bool is_free = is_known && range_m < expected_m - 0.3;
        const bool is_behind = !is_known || range_m > expected_m + 0.3;
        beam.end_cell = is_free     ? flow::EndCell::kFree
                        : is_behind ? flow::EndCell::kUnseen
                                    : flow::EndCell::kOccupied;
        beam.free_evidence = is_free ? 4.0F : is_behind ? 0.0F : -4.0F;
      }
      scan.beams.push_back(beam);
    }
    return scan;
  }

  /// Half a degree from beam to beam, the seam behind.
  void look_all_round() {
    beams = 720;
    first_beam_rad = -M_PI;
    field_of_view_rad = 719.0 / 720.0 * 2.0 * M_PI;
  }
};

}  // namespace slammot::testing
