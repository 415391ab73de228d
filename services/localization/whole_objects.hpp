#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/sensing/echo_reach.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::localization {

/// Echoes of a scan that are of a narrow object seen from one end to the other: a trunk, a post, a
/// leg of a table. The beams on both sides of it end behind it, so that its ends are its own, not
/// those of what is in front of it, and it is not so far away that a part may be out of range. A
/// beam without an echo ends behind it if it is no drop-out.
class WholeObjects {
 public:
  /// points_in_base_m: end points, one a beam. widest_m: of such an object; 0: none is looked for.
  void find(const sensing::LaserScan& scan, std::span<const geometry::Vector2> points_in_base_m,
            double min_range_m, double widest_m);

  /// Width of the object that the beam's echo is of, at most, with the gap between two beams; 0 if
  /// it is of none.
  double width_m(std::size_t beam) const { return of_beam_[beam].width_m; }
  /// Number of its echoes.
  double points(std::size_t beam) const { return of_beam_[beam].points; }

 private:
  struct Object {
    double width_m = 0.0;
    double points = 0.0;
  };

  sensing::EchoReach reach_;
  std::vector<bool> may_be_drop_out_;
  std::vector<Object> of_beam_;
};

}  // namespace slammot::localization
