#pragma once

#include <vector>

#include "common/traffic/passage.hpp"

namespace slammot::traffic {

/// A piece of a lane (vehicles), cycle lane (bicycles) or walkway (pedestrians).
struct Way {
  Mover mover = Mover::kVehicle;
  int line = 0;  ///< Pieces of one line share this number and follow each other.
  std::vector<geometry::Vector2> points_in_map_m;  ///< In the direction of travel, unless it is a
                                                   ///< walkway; at least two.
  double speed_mps = 0.0;                          ///< Mean over what passed,
  double speed_spread_mps = 0.0;                   ///< and its standard deviation.
  double width_m = 0.0;     ///< Mean width of what passed, and two standard deviations of its
                            ///< centres to either side.
  double tracks = 0.0;      ///< Number of tracks along it, mean over its length.
  double confidence = 0.0;  ///< In [0, 1), from number and agreement of the tracks.
};

}  // namespace slammot::traffic
