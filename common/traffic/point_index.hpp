#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/traffic/squares.hpp"

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
    squares_[square_key(point.position_m, kSquareM)].push_back(point);
  }

  /// True if the predicate holds for a point within the square of that half side.
  template <typename Predicate>
  bool any_near(const geometry::Vector2& centre_m, double half_side_m,
                const Predicate& holds) const {
    return any_square_near(centre_m, half_side_m, kSquareM, [&](std::uint64_t key) {
      const auto known = squares_.find(key);
      return known != squares_.end() && std::ranges::any_of(known->second, holds);
    });
  }

 private:
  static constexpr double kSquareM = 2.0;

  std::unordered_map<std::uint64_t, std::vector<LinePoint>> squares_;
};

}  // namespace slammot::traffic
