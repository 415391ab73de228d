#include "common/simulation/street_plan.hpp"

#include <cmath>
#include <numbers>

#include "common/simulation/random.hpp"

namespace slammot::simulation {
namespace {

using geometry::Vector2;
constexpr double kOuterBlockDepth_m = 45.0;

std::vector<double> street_positions_m(int blocks, const CityConfig& config, Random& random) {
  std::vector<double> positions_m{0.0};
  for (int i = 0; i < blocks; ++i) {
    const double variation = random.uniform(-config.pitch_variation, config.pitch_variation);
    positions_m.push_back(positions_m.back() + config.block_pitch_m * (1.0 + variation));
  }
  return positions_m;
}

double edge_m(const std::vector<double>& streets_m, int block) {
  if (block < 0) return streets_m.front() - kOuterBlockDepth_m;
  if (block >= static_cast<int>(streets_m.size())) return streets_m.back() + kOuterBlockDepth_m;
  return streets_m[static_cast<std::size_t>(block)];
}

}  // namespace

Direction turned_left(Direction direction, int quarter_turns) {
  return static_cast<Direction>((static_cast<int>(direction) + quarter_turns + kDirections) %
                                kDirections);
}

Vector2 unit_vector(Direction direction) {
  switch (direction) {
    case Direction::east: return {1.0, 0.0};
    case Direction::north: return {0.0, 1.0};
    case Direction::west: return {-1.0, 0.0};
    case Direction::south: break;
  }
  return {0.0, -1.0};
}

std::vector<JunctionId> along_streets(const std::vector<JunctionId>& corners) {
  if (corners.empty()) return {};
  std::vector<JunctionId> route{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    while (!(route.back() == corners[i])) {
      JunctionId next = route.back();
      next.column += (corners[i].column > next.column) - (corners[i].column < next.column);
      if (next.column == route.back().column)
        next.row += (corners[i].row > next.row) - (corners[i].row < next.row);
      route.push_back(next);
    }
  }
  return route;
}

StreetPlan::StreetPlan(const CityConfig& config, std::uint64_t seed) : config_(config) {
  Random random(seed, Purpose::world);
  columns_in_plan_m_ = street_positions_m(config.blocks_east, config, random);
  rows_in_plan_m_ = street_positions_m(config.blocks_north, config, random);
}

Vector2 StreetPlan::junction_in_plan(const JunctionId& id) const {
  return {columns_in_plan_m_[static_cast<std::size_t>(id.column)],
          rows_in_plan_m_[static_cast<std::size_t>(id.row)]};
}

std::optional<JunctionId> StreetPlan::neighbour(const JunctionId& id, Direction direction) const {
  const Vector2 step = unit_vector(direction);
  const JunctionId next{id.column + static_cast<int>(step.x()),
                        id.row + static_cast<int>(step.y())};
  if (next.column < 0 || next.column >= columns() || next.row < 0 || next.row >= rows())
    return std::nullopt;
  return next;
}

double StreetPlan::block_west_m(int column) const { return edge_m(columns_in_plan_m_, column); }
double StreetPlan::block_south_m(int row) const { return edge_m(rows_in_plan_m_, row); }

Vector2 StreetPlan::world_from_plan(const Vector2& point_in_plan) const {
  const double wave = 2.0 * std::numbers::pi / config_.bend_length_m;
  return {point_in_plan.x() + config_.bend_m * std::sin(wave * point_in_plan.y()),
          point_in_plan.y() + config_.bend_m * std::sin(wave * point_in_plan.x() + 1.0)};
}

std::vector<Vector2> StreetPlan::world_from_plan(std::vector<Vector2> points_in_plan) const {
  for (Vector2& point : points_in_plan) point = world_from_plan(point);
  return points_in_plan;
}

}  // namespace slammot::simulation
