#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::evaluator {

/// A row of walls.csv with its class: 0 wall, 1 parked car, 2 tree, bush or pole.
struct ClassedWall {
  geometry::Vector2 from_m = geometry::Vector2::Zero();  ///< In the world's frame.
  geometry::Vector2 to_m = geometry::Vector2::Zero();
  int wall_class = 0;
};

files::Result<std::vector<ClassedWall>> read_classed_walls(const std::filesystem::path& prefix);

/// One a beam: 1 if it hit a movable object.
using HitsOfMovers = std::vector<std::uint8_t>;

/// By stamp [us], as the file rounds it, for each scanner of PREFIX.hits.csv, plain or .gz. Empty
/// if there is no such file.
using HitsByScanner = std::map<std::string, std::map<std::int64_t, HitsOfMovers>>;
files::Result<HitsByScanner> read_hits_of_movers(const std::filesystem::path& prefix);

}  // namespace slammot::evaluator
