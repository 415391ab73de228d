#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/streets/driven_way.hpp"
#include "common/streets/street_network.hpp"

namespace slammot::streets {

/// A part of a stretch that lies along one link, or beside all streets.
struct Piece {
  std::size_t first = 0;  ///< Points of the way, both included.
  std::size_t last = 0;
  int stretch = 0;
  std::optional<std::size_t> link{};

  std::size_t size() const { return last - first + 1; }
};

/// Where a missing street meets the graph: the piece beside the streets runs through a node, if one
/// is near.
struct StreetEnd {
  std::size_t point = 0;          ///< Of the way: the one beside the streets next to the end.
  geometry::Vector2 left_in_map;  ///< Unit vector across the missing street.
  std::optional<std::size_t> node{};
};

/// How exactly a way follows the lines of its streets between the nodes is unknown: one of these.
constexpr std::array<double, 3> kAcrossSigmas_m{0.3, 0.6, 1.2};
using CostsBySigma = std::array<double, kAcrossSigmas_m.size()>;

/// What must be assumed of streets that the graph lacks.
struct MissingStreets {
  CostsBySigma costs{};         ///< Negative logarithms of the probability.
  std::vector<StreetEnd> ends;  ///< Those at nodes.
  int count = 0;                ///< Of streets.
};

/// Information of a point that is off by 1 m, one sigma: errors of the way across a street are
/// independent each 15 m.
inline constexpr double kPointInformation = DrivenWay::kSpacing_m / 15.0;

/// One sigma of the distance between a node and a missing street that ends there.
inline constexpr double kEndSigma_m = 1.0;

/// Explains the pieces beside all streets by missing streets. One is missing with a probability,
/// begins and ends at nodes where fewer than four streets meet, rarely elsewhere, and is a line of
/// unknown place, direction and bend: the cost is the negative logarithm of the evidence of that
/// line, so that the more turns a place leaves unexplained, the less probable it is.
MissingStreets missing_streets(const StreetNetwork& network, const DrivenWay& way,
                               const std::vector<Piece>& pieces,
                               const geometry::Pose2& streets_from_map);

}  // namespace slammot::streets
