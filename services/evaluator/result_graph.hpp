#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::evaluator {

/// A constraint between two submaps.
struct GraphEdge {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  bool is_loop = false;
  std::string state;   ///< Of a closure: "accepted", "rejected", ...; empty for others.
  std::string reason;  ///< Of that state; may be empty.
};

/// The pose graph of a result.
struct ResultGraph {
  std::map<std::uint64_t, geometry::Pose2> map_from_submap;
  std::vector<GraphEdge> edges;
};

/// Reads what files::to_g2o() writes, with its comments about closures. Lines that are malformed or
/// name unknown submaps are skipped: the graph is drawn, nothing is computed from it. Empty if
/// there is no such file.
ResultGraph read_graph(const std::filesystem::path& g2o);

}  // namespace slammot::evaluator
