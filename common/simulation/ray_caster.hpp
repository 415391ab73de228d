#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "common/simulation/surface.hpp"

namespace slammot::simulation {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// First hit of a ray; range_m is infinite without a hit.
struct Hit {
  double range_m = kInfinity;
  Material material = Material::wall;
};

/// Finds the first stationary surface along a ray with a uniform grid over the surfaces, walked
/// cell by cell (Amanatides and Woo 1987). Speed: tests/bench/ray_caster_bench.cpp.
class RayCaster {
 public:
  /// cell_m: short against a building's front, long against a beam's spacing; the best measured
  /// values are 4 m to 6 m in a city.
  explicit RayCaster(const Outline& outline_in_world, double cell_m = 5.0);

  /// First surface within max_range_m of origin_in_world along a unit direction.
  Hit cast(const geometry::Vector2& origin_in_world, const geometry::Vector2& direction_in_world,
           double max_range_m) const;

 private:
  struct Cell {
    std::uint32_t first_segment = 0, segment_count = 0;
    std::uint32_t first_circle = 0, circle_count = 0;
  };

  /// Copies each surface into every cell it touches, so that a walk reads memory in order.
  void fill_cells(const Outline& outline_in_world);
  void test_cell(const Cell& cell, const geometry::Vector2& origin_in_world,
                 const geometry::Vector2& direction_in_world, Hit& nearest) const;

  double cell_m_;
  geometry::Vector2 corner_in_world_ = geometry::Vector2::Zero();
  int columns_ = 0;
  int rows_ = 0;
  std::vector<Cell> cells_;
  std::vector<Segment> segments_by_cell_;
  std::vector<Circle> circles_by_cell_;
};

}  // namespace slammot::simulation
