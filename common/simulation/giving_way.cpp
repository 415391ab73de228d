#include "common/simulation/giving_way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/geometry/segment.hpp"

namespace slammot::simulation {
namespace {

using geometry::cross;
using geometry::Vector2;

constexpr double kHorizon_s = 2.0;       ///< Collisions with discs after this are not avoided yet.
constexpr double kWallHorizon_s = 0.5;   ///< Likewise with walls.
constexpr double kKeepsRight_rad = 0.1;  ///< Pedestrians pass each other on this side.
constexpr double kTolerance = 1e-9;

/// Velocities v with (v - point) . normal >= 0 are permitted.
struct HalfPlane {
  Vector2 point;
  Vector2 normal;
};

Vector2 left_of(const Vector2& direction) { return {-direction.y(), direction.x()}; }

/// Smallest change of the relative velocity that leaves the velocity obstacle, a cone truncated by
/// the disc of velocities that collide at the horizon, and the outward normal there.
struct Escape {
  Vector2 change;
  Vector2 normal;
};

Escape escape_from_disc(const Vector2& centre, double radius, const Vector2& velocity) {
  const Vector2 w = velocity - centre;
  const Vector2 normal = w.norm() > 0.0 ? Vector2(w.normalized()) : Vector2(1.0, 0.0);
  return {(radius - w.norm()) * normal, normal};
}

Escape escape(const Vector2& to_other_m, double radius_m, const Vector2& velocity_mps,
              double dt_s) {
  const double distance2 = to_other_m.squaredNorm();
  if (distance2 <= radius_m * radius_m)
    return escape_from_disc(to_other_m / dt_s, radius_m / dt_s, velocity_mps);
  const Vector2 w = velocity_mps - to_other_m / kHorizon_s;
  const double along = w.dot(to_other_m);
  if (along < 0.0 && along * along > radius_m * radius_m * w.squaredNorm())
    return escape_from_disc(to_other_m / kHorizon_s, radius_m / kHorizon_s, velocity_mps);
  const double leg_m = std::sqrt(distance2 - radius_m * radius_m);
  const double side = cross(to_other_m, w) > 0.0 ? 1.0 : -1.0;
  const Vector2 leg = (leg_m * to_other_m + side * radius_m * left_of(to_other_m)) / distance2;
  return {velocity_mps.dot(leg) * leg - velocity_mps, side * left_of(leg)};
}

HalfPlane permitted_beside(const Disc& self, const Disc& other, double dt_s) {
  const Escape out =
      escape(other.centre_in_world - self.centre_in_world, self.radius_m + other.radius_m,
             self.velocity_in_world_mps - other.velocity_in_world_mps, dt_s);
  const double share = other.gives_way ? 0.5 : 1.0;
  return {self.velocity_in_world_mps + share * out.change, out.normal};
}

std::optional<HalfPlane> permitted_beside(const Disc& self, const Segment& wall) {
  constexpr double kNear_m = 2.0;
  const Vector2 away =
      self.centre_in_world - geometry::nearest_on_segment(wall.a, wall.b, self.centre_in_world);
  const double distance_m = away.norm();
  if (distance_m > kNear_m || distance_m == 0.0) return std::nullopt;
  const Vector2 normal = away / distance_m;
  return HalfPlane{-std::max(0.0, distance_m - self.radius_m) / kWallHorizon_s * normal, normal};
}

/// Of the others, the nearest that a collision within the horizon is possible with.
std::vector<HalfPlane> permitted_beside(const Disc& self, std::span<const Disc> others,
                                        double most_mps, double dt_s) {
  constexpr std::size_t kMost = 12;
  std::vector<std::pair<double, const Disc*>> near;
  for (const Disc& other : others) {
    const double gap_m =
        (other.centre_in_world - self.centre_in_world).norm() - self.radius_m - other.radius_m;
    const double closing_mps =
        most_mps + self.velocity_in_world_mps.norm() + other.velocity_in_world_mps.norm();
    if (gap_m < kHorizon_s * closing_mps) near.emplace_back(gap_m, &other);
  }
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (near.size() > kMost) near.resize(kMost);
  std::vector<HalfPlane> permitted;
  for (const auto& [gap_m, other] : near) permitted.push_back(permitted_beside(self, *other, dt_s));
  return permitted;
}

bool is_permitted(std::span<const HalfPlane> permitted, const Vector2& velocity_mps,
                  double relaxed_mps) {
  return std::all_of(permitted.begin(), permitted.end(), [&](const HalfPlane& half) {
    return (velocity_mps - half.point).dot(half.normal) >= -relaxed_mps - kTolerance;
  });
}

/// Search for the permitted velocity nearest to the preferred one and not faster, with all
/// half-planes moved outwards by a speed.
struct Search {
  std::span<const HalfPlane> permitted;
  Vector2 preferred_mps;
  double relaxed_mps = 0.0;
  Vector2 best_mps = Vector2::Zero();
  double least_distance2 = std::numeric_limits<double>::infinity();  ///< Of the best one; infinite:
                                                                     ///< none found.

  void try_one(const Vector2& velocity) {
    const double distance2 = (velocity - preferred_mps).squaredNorm();
    if (distance2 >= least_distance2 || velocity.norm() > preferred_mps.norm() + kTolerance) return;
    if (!is_permitted(permitted, velocity, relaxed_mps)) return;
    best_mps = velocity;
    least_distance2 = distance2;
  }

  double offset_mps(const HalfPlane& half) const {
    return half.point.dot(half.normal) - relaxed_mps;
  }

  /// The border's point nearest to the preferred velocity, and its ends on the disc of speeds.
  void try_border(const HalfPlane& half) {
    const double chord2 = preferred_mps.squaredNorm() - offset_mps(half) * offset_mps(half);
    if (chord2 < 0.0) return;
    const Vector2 along = left_of(half.normal);
    const double end_mps = std::sqrt(chord2);
    for (const double along_mps : {preferred_mps.dot(along), -end_mps, end_mps})
      try_one(offset_mps(half) * half.normal + along_mps * along);
  }

  void try_corner(const HalfPlane& a, const HalfPlane& b) {
    const double sine = cross(a.normal, b.normal);
    if (std::abs(sine) < 1e-6) return;
    try_one((left_of(a.normal) * offset_mps(b) - left_of(b.normal) * offset_mps(a)) / sine);
  }
};

/// The optimum is the preferred velocity, or on the border of one half-plane, or of two.
std::optional<Vector2> nearest(std::span<const HalfPlane> permitted, const Vector2& preferred_mps,
                               double relaxed_mps) {
  Search search{permitted, preferred_mps, relaxed_mps};
  search.try_one(preferred_mps);
  for (std::size_t i = 0; i < permitted.size(); ++i) {
    search.try_border(permitted[i]);
    for (std::size_t j = 0; j < i; ++j) search.try_corner(permitted[i], permitted[j]);
  }
  if (std::isinf(search.least_distance2)) return std::nullopt;
  return search.best_mps;
}

/// With the least relaxation that permits a velocity, by bisection.
Vector2 least_violating(std::span<const HalfPlane> permitted, const Vector2& preferred_mps) {
  double refused_mps = 0.0;
  double enough_mps = 0.1;
  while (!nearest(permitted, preferred_mps, enough_mps) && enough_mps < 1e3) enough_mps *= 2.0;
  for (int i = 0; i < 12; ++i) {
    const double middle_mps = 0.5 * (refused_mps + enough_mps);
    (nearest(permitted, preferred_mps, middle_mps) ? enough_mps : refused_mps) = middle_mps;
  }
  return nearest(permitted, preferred_mps, enough_mps).value_or(Vector2::Zero());
}

}  // namespace

Vector2 velocity_giving_way(const Disc& self, const Vector2& preferred_mps,
                            std::span<const Disc> others, const Outline& stationary, double dt_s) {
  std::vector<HalfPlane> permitted = permitted_beside(self, others, preferred_mps.norm(), dt_s);
  for (const Segment& wall : stationary.segments) {
    if (const auto half = permitted_beside(self, wall)) permitted.push_back(*half);
  }
  if (is_permitted(permitted, preferred_mps, 0.0)) return preferred_mps;
  const Vector2 aside_mps = geometry::rotation(-kKeepsRight_rad) * preferred_mps;
  const std::optional<Vector2> best = nearest(permitted, aside_mps, 0.0);
  return best ? *best : least_violating(permitted, aside_mps);
}

}  // namespace slammot::simulation
