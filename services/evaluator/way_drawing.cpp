#include "services/evaluator/way_drawing.hpp"

#include <algorithm>

namespace slammot::evaluator {
namespace {

using geometry::Vector2;

std::vector<PlotPoint> places_of(const traffic::Way& way, const GroundView& view) {
  std::vector<PlotPoint> places;
  for (const Vector2& point_m : way.points_in_map_m) places.push_back(view.place(point_m));
  return places;
}

/// A triangle at the middle of the piece.
AreaMark arrow_of(const traffic::Way& way, const GroundView& view, const Ink& ink) {
  const std::size_t middle = way.points_in_map_m.size() / 2;
  const Vector2& tip_m = way.points_in_map_m[middle];
  const Vector2 along = (tip_m - way.points_in_map_m[middle - 1]).normalized();
  const double size_m = std::clamp(6.0 * view.metres_per_pixel, 0.8, 3.0);
  const Vector2 across(-along.y(), along.x());
  const Vector2 back_m = tip_m - size_m * along;
  return {{view.place(tip_m + size_m * along), view.place(back_m + 0.7 * size_m * across),
           view.place(back_m - 0.7 * size_m * across)},
          ink};
}

}  // namespace

const char* colour_of(traffic::Mover mover) {
  switch (mover) {
    case traffic::Mover::kVehicle: return "car";
    case traffic::Mover::kBicycle: return "bicycle";
    case traffic::Mover::kPedestrian: return "pedestrian";
  }
  return "other";
}

void add_ways(const std::vector<traffic::Way>& ways, const GroundView& view, const PageTheme& theme,
              Drawing& drawing) {
  constexpr double kFaint = 0.25;  // opacity of the width
  for (const traffic::Way& way : ways)
    drawing.marks.emplace_back(LineMark{places_of(way, view),
                                        {theme.at(colour_of(way.mover)), kFaint * way.confidence},
                                        way.width_m / view.metres_per_pixel});
  for (const traffic::Way& way : ways) {
    const Ink ink{theme.at(colour_of(way.mover)), std::clamp(0.2 + 0.8 * way.confidence, 0.0, 1.0)};
    drawing.marks.emplace_back(LineMark{places_of(way, view), ink, 1.5});
    if (traffic::is_directed(way.mover)) drawing.marks.emplace_back(arrow_of(way, view, ink));
  }
}

}  // namespace slammot::evaluator
