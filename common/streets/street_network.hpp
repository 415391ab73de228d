#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/streets/street_graph.hpp"

namespace slammot::streets {

/// A junction, an end of a street, or a point on a long street: streets are digitized there with
/// independent errors.
struct Node {
  geometry::Vector2 place_m;
  int arms = 0;  ///< Streets that leave it; 2 on a street.
};

/// A part of a street between two nodes, without a junction between them.
struct Link {
  std::array<std::size_t, 2> nodes{};
};

/// A straight part of a link.
struct LinkSegment {
  Segment segment;
  double direction_rad = 0.0;
  std::size_t link = 0;
  double share_from = 0.0;  ///< Of the link's length before the segment.
  double share_to = 1.0;    ///< Of the link's length up to its end.
};

/// The street graph in the sense of graph theory: which streets meet where.
class StreetNetwork {
 public:
  explicit StreetNetwork(const StreetGraph& graph);

  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<LinkSegment>& segments() const { return segments_; }

  /// True if two links meet at a node, or are the same.
  bool are_joined(std::size_t link_a, std::size_t link_b) const;

 private:
  std::vector<Node> nodes_;
  std::vector<Link> links_;
  std::vector<LinkSegment> segments_;
};

}  // namespace slammot::streets
