#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "common/streets/side_views.hpp"
#include "common/streets/street_network.hpp"

namespace slammot::streets {

/// An opening that a node of the graph explains: the node lies on its middle line.
struct SideMatch {
  geometry::Vector2 point_in_map;  ///< On the middle line, at the way.
  geometry::Vector2 left_in_map;   ///< Unit vector across it.
  std::size_t node = 0;
};

/// How the streets of the graph that leave a way at a place explain the openings beside it.
struct SideExplanation {
  std::vector<SideMatch> matches;
  double cost = 0.0;  ///< Negative logarithm of the probability, beside that of no street anywhere.
};

/// One sigma of the distance between a node and the middle of an opening: parked cars hide a part
/// of a street's width.
inline constexpr double kOpeningSigma_m = 2.0;

/// Compares the side streets that scans have seen with those of the graph.
class SideStreets {
 public:
  SideStreets(const StreetNetwork& network, std::vector<ViewFan> fans);

  /// within_m: of an opening from a node, across.
  SideExplanation explain(const geometry::Pose2& streets_from_map, double within_m) const;

  /// The openings by streets that the graph lacks, as on a way beside all streets.
  double cost_beside() const;

 private:
  /// What can be seen from the way, in map: a rectangle around it.
  struct View {
    geometry::Vector2 low_m = geometry::Vector2::Zero();
    geometry::Vector2 high_m = geometry::Vector2::Zero();
    double reach_m = 0.0;  ///< Of a look beyond the rectangle.
  };

  static View view_of(const std::vector<ViewFan>& fans);
  std::vector<std::size_t> nodes_in_view(const geometry::Pose2& map_from_streets,
                                         double within_m) const;
  bool has_arm(std::size_t node, double direction_rad) const;
  double cost_of_closed(const geometry::Pose2& streets_from_map,
                        const std::vector<std::size_t>& nodes) const;

  const StreetNetwork& network_;
  std::vector<std::vector<double>> arms_rad_;  ///< Directions of the streets that leave each node.
  std::vector<ViewFan> fans_;
  std::vector<Opening> openings_;
  View view_;
};

}  // namespace slammot::streets
