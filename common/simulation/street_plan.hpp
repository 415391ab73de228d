#pragma once

#include <optional>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::simulation {

/// Cross-section of every street, metres from its centre line, and the layout of the city.
struct CityConfig {
  int blocks_east = 4;
  int blocks_north = 3;
  double block_pitch_m = 110.0;   ///< From street to street, before the variation below.
  double pitch_variation = 0.15;  ///< Each row and column of blocks differs by up to this share.
  double bend_m = 4.0;            ///< Streets swing this far to either side of straight.
  double bend_length_m = 420.0;   ///< Wavelength of that swing.
  double lane_offset_m = 1.75;
  double bicycle_offset_m = 3.55;
  double parking_offset_m = 5.25;
  double curb_m = 6.3;
  double front_m = 9.6;          ///< Nearest a building comes.
  double stop_line_m = 11.0;     ///< From the junction's centre.
  double signalled_share = 0.6;  ///< Of the junctions; the others go by who comes first.
  double parked_share = 0.35;    ///< Of the kerb.
  double tree_spacing_m = 14.0;
  double lamp_spacing_m = 27.0;
  double park_share = 0.08;  ///< Blocks with trees and bushes in place of buildings.
  double gap_share = 0.12;   ///< Of a block's side: alleys and car parks between buildings.
};

/// Compass directions of the plan, counter-clockwise, as streets leave a junction.
enum class Direction : int { east = 0, north = 1, west = 2, south = 3 };
constexpr int kDirections = 4;
Direction turned_left(Direction direction, int quarter_turns);
geometry::Vector2 unit_vector(Direction direction);

/// Column (east) and row (north) of a junction.
struct JunctionId {
  int column = 0;
  int row = 0;
  bool operator==(const JunctionId&) const = default;
};

/// Every junction along straight streets from corner to corner, each once, both ends included.
std::vector<JunctionId> along_streets(const std::vector<JunctionId>& corners);

/// Where the streets are: a grid in plan coordinates (straight streets), bent smoothly into the
/// world.
class StreetPlan {
 public:
  StreetPlan(const CityConfig& config, std::uint64_t seed);

  const CityConfig& config() const { return config_; }
  int columns() const { return static_cast<int>(columns_in_plan_m_.size()); }
  int rows() const { return static_cast<int>(rows_in_plan_m_.size()); }
  int junction_count() const { return columns() * rows(); }
  int index(const JunctionId& id) const { return id.row * columns() + id.column; }
  JunctionId junction(int index) const { return {index % columns(), index / columns()}; }

  geometry::Vector2 junction_in_plan(const JunctionId& id) const;
  /// Next junction in a direction; none at the edge of the city.
  std::optional<JunctionId> neighbour(const JunctionId& id, Direction direction) const;
  /// West/south edge of the given column/row of blocks; -1 and the last are the blocks outside the
  /// outer streets.
  double block_west_m(int column) const;
  double block_south_m(int row) const;

  geometry::Vector2 world_from_plan(const geometry::Vector2& point_in_plan) const;
  std::vector<geometry::Vector2> world_from_plan(
      std::vector<geometry::Vector2> points_in_plan) const;

 private:
  CityConfig config_;
  std::vector<double> columns_in_plan_m_;
  std::vector<double> rows_in_plan_m_;
};

}  // namespace slammot::simulation
