#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::traffic {

/// A point of a line, with the direction of the line there.
struct LinePoint {
  geometry::Vector2 position_m = geometry::Vector2::Zero();
  geometry::Vector2 direction = geometry::Vector2::UnitX();
  int line = 0;
  int station = 0;  ///< Along the line.
};

/// Finds points of lines by their place.
class PointIndex {
 public:
  void add(const LinePoint& point) {
    squares_[key_of(square(point.position_m.x()), square(point.position_m.y()))].push_back(point);
  }

  /// True if the predicate holds for a point within the square of that half side.
  template <typename Predicate>
  bool any_near(const geometry::Vector2& centre_m, double half_side_m,
                const Predicate& holds) const {
    for (std::int32_t row = square(centre_m.y() - half_side_m);
         row <= square(centre_m.y() + half_side_m); ++row) {
      for (std::int32_t column = square(centre_m.x() - half_side_m);
           column <= square(centre_m.x() + half_side_m); ++column) {
        const auto known = squares_.find(key_of(column, row));
        if (known == squares_.end()) continue;
        for (const LinePoint& point : known->second) {
          if (holds(point)) return true;
        }
      }
    }
    return false;
  }

 private:
  static constexpr double kSquareM = 2.0;

  static std::int32_t square(double coordinate_m) {
    return static_cast<std::int32_t>(std::floor(coordinate_m / kSquareM));
  }
  static std::uint64_t key_of(std::int32_t column, std::int32_t row) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32U) |
           static_cast<std::uint32_t>(row);
  }

  std::unordered_map<std::uint64_t, std::vector<LinePoint>> squares_;
};

}  // namespace slammot::traffic
