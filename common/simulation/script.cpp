#include "common/simulation/script.hpp"

#include <cmath>

#include "common/simulation/random.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

Vector2 vector(const PlaceInWorld& place) { return {place.x_m, place.y_m}; }

/// Bays of one straight piece: each stands at its own depth to the left, joined by short walls
/// across.
void add_front(Outline& outline, const Vector2& from, const Vector2& to, const ScriptedFront& front,
               Random& random) {
  const Vector2 along = (to - from).normalized();
  const Vector2 left{-along.y(), along.x()};
  const double length_m = (to - from).norm();
  double begin_m = 0.0;
  bool gap_before = true;
  Vector2 last_end = from;
  while (begin_m < length_m) {
    const double width_m = front.bay_m * random.uniform(0.5, 1.5);
    const double end_m = front.depth_m == 0.0 && front.gap_share == 0.0
                             ? length_m
                             : std::min(length_m, begin_m + width_m);
    const double depth_m = front.depth_m * random.uniform();
    const bool gap = random.chance(front.gap_share);
    const Vector2 a = from + begin_m * along + depth_m * left;
    const Vector2 b = from + end_m * along + depth_m * left;
    if (!gap) {
      if (!gap_before) outline.segments.push_back({last_end, a, Material::wall});
      outline.segments.push_back({a, b, Material::wall});
    }
    gap_before = gap;
    last_end = b;
    begin_m = end_m;
  }
}

void add_thing(Outline& outline, const ScriptedRow& row, const Vector2& place, double heading_rad) {
  switch (row.of) {
    case RowOf::post: outline.circles.push_back({place, row.radius_m, Material::post}); return;
    case RowOf::bush: outline.circles.push_back({place, row.radius_m, Material::foliage}); return;
    case RowOf::parked_car: break;
  }
  std::vector<Vector2> corners = cut_rectangle(4.4, 1.8, 0.35);
  const Pose2 world_from_car{place.x(), place.y(), heading_rad};
  for (Vector2& corner : corners) corner = world_from_car * corner;
  add_polygon(outline, corners, Material::parked_car);
}

void add_row(Outline& outline, const ScriptedRow& row, Random& random) {
  const Vector2 span = vector(row.to) - vector(row.from);
  const int more = row.spacing_m > 0.0 ? static_cast<int>(span.norm() / row.spacing_m) : 0;
  const double heading_rad = span.norm() > 0.0 ? std::atan2(span.y(), span.x()) : 0.0;
  for (int i = 0; i <= more; ++i) {
    const Vector2 shift{random.uniform(-row.variation_m, row.variation_m),
                        random.uniform(-row.variation_m, row.variation_m)};
    const Vector2 step =
        more > 0 ? Vector2(row.spacing_m * i * span.normalized()) : Vector2::Zero();
    add_thing(outline, row, vector(row.from) + step + shift, heading_rad);
  }
}

}  // namespace

Outline build_script(const ScriptConfig& config, std::uint64_t seed) {
  Random random(seed, Purpose::world);
  Outline outline;
  for (const ScriptedFront& front : config.fronts) {
    for (std::size_t i = 1; i < front.along.size(); ++i)
      add_front(outline, vector(front.along[i - 1]), vector(front.along[i]), front, random);
  }
  for (const ScriptedRow& row : config.rows) add_row(outline, row, random);
  return outline;
}

}  // namespace slammot::simulation
