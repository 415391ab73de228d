#include "common/streets/side_streets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kOpeningTurn_rad = 0.4;    // between an opening and its street
constexpr double kSeenOpen = 0.85;          // probability that a street is seen as an opening,
constexpr double kSeenOpenUnmapped = 0.25;  // or one where the graph has a junction, but no street
constexpr double kStreetsPer_m = 0.01;      // junctions along a way: a block is 100 m long
constexpr double kOthersPer_m = 0.002;      // openings at no junction of the graph
constexpr double kSurelyClosed_m = 3.0;     // to either side of a street's middle
constexpr int kLeastClosed = 5;             // looks
constexpr double kFanReach_m = 40.0;        // of a fan beyond its looks

/// Of an opening with that probability at its node, beside one at no junction.
double cost_of_match(double probability) {
  return std::log(std::sqrt(2.0 * std::numbers::pi) * kOpeningSigma_m * kOthersPer_m / probability);
}

struct LookedInto {
  int open = 0;
  int closed = 0;
};

/// What was seen into a street with that node.
LookedInto looked_into(const ViewFan& fan, const Vector2& node_in_map) {
  LookedInto looked;
  for (std::size_t i = 0; i < fan.looks.size(); ++i) {
    const Vector2 rel_m = geometry::inverse(fan.looks[i]) * node_in_map;
    if (std::abs(rel_m.y()) > kSurelyClosed_m || rel_m.x() < fan.nearest_m ||
        rel_m.x() > fan.farthest_m)
      continue;
    looked.open += fan.views[i] == View::kOpen ? 1 : 0;
    looked.closed += fan.views[i] == View::kClosed ? 1 : 0;
  }
  return looked;
}

/// The same by all fans that look along the street.
LookedInto looked_into(const std::vector<ViewFan>& fans, const Vector2& node_in_map,
                       double direction_rad) {
  LookedInto all;
  for (const ViewFan& fan : fans) {
    if (fan.looks.empty()) continue;
    const Pose2& middle = fan.looks[fan.looks.size() / 2];
    const double reach_m = 0.5 * static_cast<double>(fan.looks.size()) + kFanReach_m;
    if (std::abs(geometry::wrap_angle(direction_rad - middle.heading_rad)) > kOpeningTurn_rad ||
        (middle.translation_m() - node_in_map).norm() > reach_m)
      continue;
    const LookedInto looked = looked_into(fan, node_in_map);
    all.open += looked.open;
    all.closed += looked.closed;
  }
  return all;
}

/// Of these nodes, ascending.
std::optional<std::size_t> nearest_node(const StreetNetwork& network,
                                        const std::vector<std::size_t>& nodes,
                                        const Opening& opening, const Pose2& look_from_streets,
                                        double within_m) {
  std::optional<std::size_t> nearest;
  for (const std::size_t i : nodes) {
    const Vector2 rel_m = look_from_streets * network.nodes()[i].place_m;
    if (rel_m.x() < opening.nearest_m || rel_m.x() > opening.farthest_m ||
        std::abs(rel_m.y()) >= within_m)
      continue;
    within_m = std::abs(rel_m.y());
    nearest = i;
  }
  return nearest;
}

}  // namespace

SideStreets::SideStreets(const StreetNetwork& network, std::vector<ViewFan> fans)
    : network_(network),
      arms_rad_(network.nodes().size()),
      fans_(std::move(fans)),
      openings_(openings_of(fans_)),
      view_(view_of(fans_)) {
  const auto& links = network.links();
  std::vector<const LinkSegment*> first(links.size(), nullptr);
  std::vector<const LinkSegment*> last(links.size(), nullptr);
  for (const LinkSegment& part : network.segments()) {
    if (first[part.link] == nullptr) first[part.link] = &part;
    last[part.link] = &part;
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    arms_rad_[links[i].nodes[0]].push_back(first[i]->direction_rad);
    arms_rad_[links[i].nodes[1]].push_back(last[i]->direction_rad + std::numbers::pi);
  }
}

SideStreets::View SideStreets::view_of(const std::vector<ViewFan>& fans) {
  View view{Vector2::Constant(std::numeric_limits<double>::max()),
            Vector2::Constant(std::numeric_limits<double>::lowest()), 0.0};
  for (const ViewFan& fan : fans) {
    view.reach_m = std::max(view.reach_m, fan.farthest_m);
    for (const Pose2& look : fan.looks) {
      view.low_m = view.low_m.cwiseMin(look.translation_m());
      view.high_m = view.high_m.cwiseMax(look.translation_m());
    }
  }
  return view;
}

/// Nodes that a look or an opening may meet, ascending; few of a large graph.
std::vector<std::size_t> SideStreets::nodes_in_view(const Pose2& map_from_streets,
                                                    double within_m) const {
  constexpr double kRounding_m = 1.0;
  const double margin_m = view_.reach_m + std::max(within_m, kSurelyClosed_m) + kRounding_m;
  const geometry::Matrix2 turn = geometry::rotation(map_from_streets.heading_rad);
  const Vector2 origin_m = map_from_streets.translation_m();
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < network_.nodes().size(); ++i) {
    const Vector2 in_map_m = turn * network_.nodes()[i].place_m + origin_m;
    if (((in_map_m - view_.low_m).array() >= -margin_m).all() &&
        ((in_map_m - view_.high_m).array() <= margin_m).all())
      nodes.push_back(i);
  }
  return nodes;
}

bool SideStreets::has_arm(std::size_t node, double direction_rad) const {
  return std::ranges::any_of(arms_rad_[node], [&](double arm_rad) {
    return std::abs(geometry::wrap_angle(arm_rad - direction_rad)) < kOpeningTurn_rad;
  });
}

/// Two openings at one junction, to both sides of the way, do not come about independently: they
/// count once.
SideExplanation SideStreets::explain(const Pose2& streets_from_map, double within_m) const {
  SideExplanation explanation;
  std::map<std::size_t, double> costs;
  const std::vector<std::size_t> nodes =
      nodes_in_view(geometry::inverse(streets_from_map), within_m);
  for (const Opening& opening : openings_) {
    const Pose2 placed = streets_from_map * opening.map_from_look;
    const auto node = nearest_node(network_, nodes, opening, geometry::inverse(placed), within_m);
    if (!node) continue;
    const double heading_rad = opening.map_from_look.heading_rad;
    explanation.matches.push_back({opening.map_from_look.translation_m(),
                                   {-std::sin(heading_rad), std::cos(heading_rad)},
                                   *node});
    const double cost =
        cost_of_match(has_arm(*node, placed.heading_rad) ? kSeenOpen : kSeenOpenUnmapped);
    const auto [known, is_new] = costs.try_emplace(*node, cost);
    known->second = std::min(known->second, cost);
  }
  for (const auto& [node, cost] : costs) explanation.cost += cost;
  explanation.cost += cost_of_closed(streets_from_map, nodes);
  return explanation;
}

/// Streets of the graph where something stands.
double SideStreets::cost_of_closed(const Pose2& streets_from_map,
                                   const std::vector<std::size_t>& nodes) const {
  const Pose2 map_from_streets = geometry::inverse(streets_from_map);
  double cost = 0.0;
  for (const std::size_t node : nodes) {
    const Vector2 node_in_map = map_from_streets * network_.nodes()[node].place_m;
    for (const double arm_rad : arms_rad_[node]) {
      const LookedInto all =
          looked_into(fans_, node_in_map, arm_rad - streets_from_map.heading_rad);
      if (all.open == 0 && all.closed >= kLeastClosed) cost -= std::log(1.0 - kSeenOpen);
    }
  }
  return cost;
}

/// Junctions to the side that the graph lacks: about half of the openings, as most have two.
double SideStreets::cost_beside() const {
  return -0.5 * static_cast<double>(openings_.size()) * std::log(kStreetsPer_m / kOthersPer_m);
}

}  // namespace slammot::streets
