#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "common/sensing/floor_survey.hpp"

namespace slammot::testing {

using geometry::Pose2;
using geometry::Vector2;

inline constexpr std::size_t kHalfCircleBeams = 181;
inline constexpr double kFloorDegree = std::numbers::pi / 180.0;
inline constexpr double kNoFloor = std::numeric_limits<double>::infinity();
inline const sensing::SurveyedBeams kHalfCircle{-90.0 * kFloorDegree, kFloorDegree, 0.0, 1.0, 80.0};

inline double floor_angle_of(std::size_t beam) {
  return kHalfCircle.first_beam_rad + kFloorDegree * static_cast<double>(beam);
}

inline double range_along(double inverse_per_m) {
  return inverse_per_m > 0.0 ? 1.0 / inverse_per_m : kNoFloor;
}

/// A rectangular hall. The floor is the line floor . (x, y) = 1 in the scanner's frame.
struct FloorHall {
  Vector2 floor{0.0, 0.0};
  double sway = 0.0;           ///< One sigma of the floor's inverse distance, relative.
  Vector2 hall_m{15.0, 10.0};  ///< Half length and half width.
};

/// A scanner of half a circle whose beams meet the floor of the hall.
class TiltedScanner {
 public:
  explicit TiltedScanner(const FloorHall& hall) : hall_(hall) {}

  std::vector<float> scan(const Pose2& world_from_laser) {
    const Vector2 now = hall_.floor * (1.0 + hall_.sway * noise_(random_));
    std::vector<float> readings;
    for (std::size_t beam = 0; beam < kHalfCircleBeams; ++beam) {
      const Vector2 direction(std::cos(floor_angle_of(beam)), std::sin(floor_angle_of(beam)));
      const double range_m =
          std::min(range_along(now.dot(direction)), range_of_walls_m(world_from_laser, direction));
      readings.push_back(static_cast<float>(range_m + 0.01 * noise_(random_)));
    }
    return readings;
  }

  /// Drives in curves.
  Pose2 pose(int step) const {
    const double s = 0.1 * step;
    return {0.6 * hall_.hall_m.x() * std::sin(0.31 * s),
            0.6 * hall_.hall_m.y() * std::sin(0.43 * s), geometry::wrap_angle(0.7 * s)};
  }

 private:
  double range_of_walls_m(const Pose2& world_from_laser, const Vector2& direction) const {
    const Vector2 in_world = geometry::rotation(world_from_laser.heading_rad) * direction;
    double range_m = kNoFloor;
    for (int axis = 0; axis < 2; ++axis) {
      const double place_m = world_from_laser.translation_m()[axis];
      const double wall_m = in_world[axis] > 0.0 ? hall_.hall_m[axis] : -hall_.hall_m[axis];
      if (in_world[axis] != 0.0) range_m = std::min(range_m, (wall_m - place_m) / in_world[axis]);
    }
    return range_m;
  }

  FloorHall hall_;
  std::mt19937 random_{3};
  std::normal_distribution<double> noise_;
};

}  // namespace slammot::testing
