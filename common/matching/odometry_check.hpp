#pragma once

#include <array>
#include <complex>
#include <numbers>
#include <optional>

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// Tests whether odometry's positions move along its headings, step by step. A step lies along the
/// heading in its middle, forward or backward, up to a constant angle. Mirrored positions do so
/// with the heading's sign changed.
class OdometryCheck {
 public:
  void add(const geometry::Pose2& recorded);  ///< The heading is unwrapped, as recorded.

  bool is_in_degrees() const;
  bool positions_are_mirrored() const;  ///< Relative to the headings; does not say which of the two
                                        ///< is correct.
  /// True if chords turn against the headings, or if a point far from the turning axle moves as if
  /// behind it: the turns' sign is wrong. unit_m: metres per unit of the positions.
  bool turns_against_its_arcs(double unit_m) const;
  /// True if chords turn with the headings, or if a point far from the axle moves as if ahead of
  /// it. Neither is true if arcs of single steps are not observable.
  bool turns_with_its_arcs(double unit_m) const;
  double mirrored_direction_rad() const;  ///< Direction of positions minus mirrored headings,
                                          ///< modulo pi.

 private:
  double arcs_per_turn() const;
  std::optional<double> ahead_of_axle_m(double unit_m) const;

  struct Unit {
    double radians;                      ///< Per unit of the headings.
    std::complex<double> along = {};     ///< Sum of way * exp(2i (direction - heading)).
    std::complex<double> mirrored = {};  ///< Sum of way * exp(2i (direction + heading)).
    double arc = 0.0;                    ///< Sum of way * sin(direction - heading) * turn.
    double arc_turn = 0.0;               ///< Sum of way * turn^2.
    Eigen::Matrix2d turning = Eigen::Matrix2d::Zero();  ///< Normal equations of sideways = ahead *
                                                        ///< turn + k * forward * turn.
    Eigen::Vector2d sideways = Eigen::Vector2d::Zero();
    double squared_sideways = 0.0;
    int steps = 0;
  };
  const Unit& unit() const { return units_[is_in_degrees() ? 1 : 0]; }

  std::array<Unit, 2> units_{Unit{.radians = 1.0}, Unit{.radians = std::numbers::pi / 180.0}};
  double way_ = 0.0;
  double largest_heading_ = 0.0;
  std::optional<geometry::Pose2> before_;
};

}  // namespace slammot::matching
