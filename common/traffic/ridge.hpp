#pragma once

#include <optional>
#include <vector>

#include "common/traffic/traffic_map.hpp"

namespace slammot::traffic {

/// Kernel and steps of a kind of mover.
struct RidgeScale {
  double along_m = 2.5;        ///< Half length of the kernel, along the way
  double across_m = 1.6;       ///< and across: lanes of one direction are twice this apart.
  double least_cosine = 0.71;  ///< Of the angle between streams of one way.
  double step_m = 1.0;
};

RidgeScale ridge_scale(Mover mover);

/// What passes a place of a ridge.
struct RidgePoint {
  geometry::Vector2 position_m = geometry::Vector2::Zero();
  geometry::Vector2 direction = geometry::Vector2::UnitX();
  double tracks = 0.0;
  double agreement = 0.0;  ///< Mean resultant length of the directions.
  double speed_mps = 0.0;
  double speed_spread_mps = 0.0;
  double mover_width_m = 0.0;
  double spread_m = 0.0;  ///< Standard deviation of the centres, across.
};

/// Point of the ridge of the density of streams beside the place: mean shift, only across the
/// direction of travel (Ozertem and Erdogmus 2011), over streams that agree in direction. None if
/// less than half a track passes.
std::optional<RidgePoint> ridge_point(const TrafficMap& map, Mover mover, const RidgePoint& near,
                                      int iterations);

/// Lines along the ridges of a kind of mover, from the densest place on; a line ends where nothing
/// passes any more, or with the point at which it joins another.
std::vector<std::vector<RidgePoint>> follow_ridges(const TrafficMap& map, Mover mover);

}  // namespace slammot::traffic
