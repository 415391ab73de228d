#pragma once

#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::simulation {

/// Height of the road at a place; linear between places, level before the first and after the last.
struct HeightAt {
  double x_m = 0.0;  ///< World frame; the road is equally high along y.
  double z_m = 0.0;
};

/// Height profile of the ground.
class Terrain {
 public:
  Terrain() = default;  ///< Level, at height 0.
  explicit Terrain(std::vector<HeightAt> heights)
      : heights_(std::move(heights)) {}  ///< Ascending x_m.

  double height_m(double x_m) const;
  /// Pitch of a body on the road for its heading, nose down.
  double nose_down_rad(const geometry::Pose2& world_from_body) const;
  /// Horizontal distance at which a ray hits the road; infinite if it does not. rise: metres up per
  /// metre ahead.
  double distance_to_ground(const geometry::Vector2& origin_in_world,
                            const geometry::Vector2& direction_in_world, double origin_z_m,
                            double rise) const;

 private:
  std::vector<HeightAt> heights_;
};

inline const Terrain kLevelRoad{};

}  // namespace slammot::simulation
