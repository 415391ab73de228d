#include "common/matching/odometry_check.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace slammot::matching {
namespace {

constexpr double kLeastDirection = 0.75;  // length of a mean direction vector
constexpr double kClearlyInDegrees = 0.35;
constexpr double kArcsSeen = 0.1;
constexpr double kEitherWay = -0.5;

}  // namespace

using geometry::Pose2;
using geometry::wrap_angle;

void OdometryCheck::add(const Pose2& recorded) {
  largest_heading_ = std::max(largest_heading_, std::abs(recorded.heading_rad));
  const std::optional<Pose2> before = before_;
  before_ = recorded;
  if (!before) return;
  const double way = std::hypot(recorded.x_m - before->x_m, recorded.y_m - before->y_m);
  if (!(way > 0.0)) return;
  const double direction = std::atan2(recorded.y_m - before->y_m, recorded.x_m - before->x_m);
  for (Unit& unit : units_) {
    const double turn = wrap_angle((recorded.heading_rad - before->heading_rad) * unit.radians);
    const double heading = before->heading_rad * unit.radians + 0.5 * turn;
    unit.along += way * std::polar(1.0, 2.0 * (direction - heading));
    unit.mirrored += way * std::polar(1.0, 2.0 * (direction + heading));
    const double forward = std::cos(direction - heading) < 0.0 ? std::numbers::pi : 0.0;
    if (std::abs(turn) > 0.5) continue;
    unit.arc += way * std::sin(direction - heading - forward) * turn;
    unit.arc_turn += way * turn * turn;
    const double from_heading = direction - before->heading_rad * unit.radians;
    const double sideways = way * std::sin(from_heading);
    const Eigen::Vector2d by(turn, way * std::cos(from_heading) * turn);
    unit.turning += by * by.transpose();
    unit.sideways += sideways * by;
    unit.squared_sideways += sideways * sideways;
    ++unit.steps;
  }
  way_ += way;
}

bool OdometryCheck::is_in_degrees() const {
  constexpr double kOneTurn = 6.5;
  if (largest_heading_ < kOneTurn || way_ <= 0.0) return false;
  const auto fit = [&](const Unit& unit) {
    return std::max(std::abs(unit.along), std::abs(unit.mirrored)) / way_;
  };
  return fit(units_[1]) > fit(units_[0]) + kClearlyInDegrees;
}

bool OdometryCheck::positions_are_mirrored() const {
  if (way_ <= 0.0) return false;
  // On streets that cross at right angles both are consistent, but one fits far less exactly.
  constexpr double kSpreadShare = 0.25;
  constexpr double kLeastSpread = 1e-3;
  const double mirrored = std::abs(unit().mirrored) / way_;
  const double along = std::abs(unit().along) / way_;
  return mirrored > kLeastDirection && 1.0 - along > kLeastSpread &&
         1.0 - mirrored < kSpreadShare * (1.0 - along);
}

/// Mean offset of chords against the arc. 0: chords lie along the heading in their middle, as on
/// arcs. -0.5: chords lie along the first heading. Lower if positions are later than headings,
/// higher if they are earlier. With the wrong turn sign, a becomes -1 - a.
double OdometryCheck::arcs_per_turn() const {
  return unit().arc_turn > 0.0 ? unit().arc / unit().arc_turn : kEitherWay;
}

/// Distance of the reference point ahead of the turning axle, if it is as large as on cars. A point
/// c ahead moves sideways by c times the turn, into the turn. With the wrong turn sign it is -c,
/// and no car steers from behind its axle.
std::optional<double> OdometryCheck::ahead_of_axle_m(double unit_m) const {
  constexpr double kOfCars_m = 0.3;
  constexpr double kSigmas = 5.0;
  constexpr double kLeastDistinct = 1e-6;  // at one speed an offset cannot be told from a delay
  const Eigen::Matrix2d& turning = unit().turning;
  if (unit().steps < 3 || !(turning.determinant() > kLeastDistinct * turning(0, 0) * turning(1, 1)))
    return std::nullopt;
  const Eigen::Matrix2d covariance = turning.inverse();
  const Eigen::Vector2d fit = covariance * unit().sideways;
  const double variance =
      std::max(unit().squared_sideways - fit.dot(unit().sideways), 0.0) / (unit().steps - 2);
  const bool is_seen = std::abs(fit.x()) > kSigmas * std::sqrt(variance * covariance(0, 0));
  return is_seen && std::abs(fit.x()) * unit_m > kOfCars_m ? std::optional(fit.x() * unit_m)
                                                           : std::nullopt;
}

bool OdometryCheck::turns_against_its_arcs(double unit_m) const {
  if (const auto ahead_m = ahead_of_axle_m(unit_m)) return *ahead_m < 0.0;
  return std::abs(arcs_per_turn() + 1.0) < kArcsSeen || arcs_per_turn() > kArcsSeen;
}

bool OdometryCheck::turns_with_its_arcs(double unit_m) const {
  if (const auto ahead_m = ahead_of_axle_m(unit_m)) return *ahead_m > 0.0;
  return std::abs(arcs_per_turn()) < kArcsSeen || arcs_per_turn() < -1.0 - kArcsSeen;
}

double OdometryCheck::mirrored_direction_rad() const { return 0.5 * std::arg(unit().mirrored); }

}  // namespace slammot::matching
