#include "common/streets/street_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <Eigen/Cholesky>

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kMostAcross_m = 14.0;  // of a point on a street
constexpr double kMostAlong_m = 8.0;    // beyond its end
constexpr double kMostTurn_rad = 0.35;
constexpr std::size_t kLeastPoints = 3;  // of a piece on a street
constexpr int kSteps = 8;
constexpr double kSettled_m = 0.05;
constexpr double kSettled_rad = 0.0005;
constexpr int kMostMissing = 4;
constexpr double kSide_m = 7.0;        // of an opening from its street: three and a half sigmas
constexpr double kFirstSide_m = 14.0;  // before the place is refined

/// Negative logarithm of the mean of the evidences.
double mean_cost(const CostsBySigma& costs) {
  const double least = std::ranges::min(costs);
  double sum = 0.0;
  for (const double cost : costs) sum += std::exp(least - cost);
  return least - std::log(sum / static_cast<double>(costs.size()));
}

/// Gauss and Newton for the place about the way's middle (x, y, heading), the lane, and the errors
/// of the nodes (x, y).
class NormalEquations {
 public:
  static constexpr int kLane = 3;
  static constexpr int kNodes = 4;

  NormalEquations(const StreetPrior& prior, const StreetNetwork& network,
                  const std::vector<Piece>& pieces, const std::vector<SideMatch>& sides) {
    for (const Piece& piece : pieces) {
      if (!piece.link) continue;
      for (const std::size_t node : network.links()[*piece.link].nodes) add_node(node);
    }
    for (const SideMatch& side : sides) add_node(side.node);
    const Eigen::Index size = kNodes + 2 * static_cast<Eigen::Index>(columns_.size());
    prior_ = Eigen::VectorXd::Constant(size, prior.node_sigma_m);
    prior_.head<kNodes>() << prior.place_sigma_m, prior.place_sigma_m, prior.heading_sigma_rad,
        prior.lane_sigma_m;
    prior_ = prior_.array().square().inverse();
    points_ = ends_ = Sums(size);
  }

  /// A place `arm_m` from the way's middle lies `across_m` left of the lane between two nodes, at a
  /// share of the way from the first to the second.
  struct Observation {
    Vector2 arm_m;
    Vector2 left;
    double across_m = 0.0;
    std::array<std::size_t, 2> nodes{};
    double share = 0.0;
  };

  void add_point(const Observation& seen) { add(seen, kPointInformation, points_); }
  void add_end(const Observation& seen) { add(seen, 1.0 / (kEndSigma_m * kEndSigma_m), ends_); }
  void add_side(const Observation& seen) {
    add(seen, 1.0 / (kOpeningSigma_m * kOpeningSigma_m), ends_);
  }

  /// Solves them, for each accuracy of the way across streets. `beside` are the costs of what is
  /// beside the streets.
  void solve(const CostsBySigma& beside, std::size_t point_count) {
    const double count = kPointInformation * static_cast<double>(point_count);
    double least = std::numeric_limits<double>::infinity();
    CostsBySigma costs{};
    for (std::size_t k = 0; k < kAcrossSigmas_m.size(); ++k) {
      const double weight = 1.0 / (kAcrossSigmas_m[k] * kAcrossSigmas_m[k]);
      Eigen::MatrixXd information = weight * points_.information + ends_.information;
      information.diagonal() += prior_;
      const Eigen::VectorXd gradient = weight * points_.gradient + ends_.gradient;
      const Eigen::LDLT<Eigen::MatrixXd> solved(information);
      const Eigen::VectorXd change = -solved.solve(gradient);
      const double squares =
          std::max(0.0, weight * points_.squares + ends_.squares + gradient.dot(change));
      costs[k] =
          0.5 * (squares + solved.vectorD().array().log().sum() - prior_.array().log().sum()) +
          beside[k] + count * std::log(kAcrossSigmas_m[k]);
      if (costs[k] >= least) continue;
      least = costs[k];
      change_ = change;
      squares_ = squares;
    }
    cost_ = mean_cost(costs);
  }
  double cost() const { return cost_; }
  double squares() const { return 0.5 * squares_; }

  Pose2 moved(const Pose2& pose, const Vector2& middle_m) const {
    const Vector2 moved_m = geometry::rotation(change_(2)) * (pose.translation_m() - middle_m) +
                            middle_m + Vector2(change_.head<2>());
    return {moved_m.x(), moved_m.y(), geometry::wrap_angle(pose.heading_rad + change_(2))};
  }
  bool is_settled() const {
    return change_.head<2>().norm() < kSettled_m && std::abs(change_(2)) < kSettled_rad;
  }

 private:
  struct Sums {
    explicit Sums(Eigen::Index size = 0)
        : information(Eigen::MatrixXd::Zero(size, size)), gradient(Eigen::VectorXd::Zero(size)) {}
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
    double squares = 0.0;
  };

  void add_node(std::size_t node) {
    columns_.try_emplace(node, kNodes + 2 * static_cast<int>(columns_.size()));
  }

  void add(const Observation& seen, double weight, Sums& sums) const {
    const int first = columns_.at(seen.nodes[0]);
    const int second = columns_.at(seen.nodes[1]);
    const Vector2 of_first = -(1.0 - seen.share) * seen.left;
    const Vector2 of_second = -seen.share * seen.left;
    const std::array<std::pair<int, double>, 8> row{{{0, seen.left.x()},
                                                     {1, seen.left.y()},
                                                     {2, geometry::cross(seen.arm_m, seen.left)},
                                                     {kLane, -1.0},
                                                     {first, of_first.x()},
                                                     {first + 1, of_first.y()},
                                                     {second, of_second.x()},
                                                     {second + 1, of_second.y()}}};
    for (const auto& [i, a] : row) {
      for (const auto& [j, b] : row) sums.information(i, j) += weight * a * b;
      sums.gradient(i) += weight * a * seen.across_m;
    }
    sums.squares += weight * seen.across_m * seen.across_m;
  }

  std::unordered_map<std::size_t, int> columns_;
  Eigen::VectorXd prior_;
  Sums points_;
  Sums ends_;
  Eigen::VectorXd change_;
  double squares_ = 0.0;
  double cost_ = 0.0;
};

struct Scene {
  const StreetNetwork& network;
  const StreetField& field;
  const DrivenWay& way;
};

void add_piece(NormalEquations& equations, const Scene& scene, const Piece& piece,
               const Pose2& streets_from_map, const Vector2& middle_m) {
  for (std::size_t i = piece.first; i <= piece.last; ++i) {
    const Pose2 placed = streets_from_map * scene.way.points[i];
    const auto nearest = scene.field.nearest(placed);
    if (!nearest || nearest->part->link != *piece.link) continue;
    const Vector2 left{-std::sin(nearest->direction_rad), std::cos(nearest->direction_rad)};
    equations.add_point({placed.translation_m() - middle_m, left,
                         left.dot(placed.translation_m() - nearest->point_m),
                         scene.network.links()[*piece.link].nodes, nearest->share_of_link()});
  }
}

/// A missing street leads through the node at its end.
void add_end(NormalEquations& equations, const Scene& scene, const StreetEnd& end,
             const Pose2& streets_from_map, const Vector2& middle_m) {
  const Vector2 node_m = scene.network.nodes()[*end.node].place_m;
  const Vector2 left = geometry::rotation(streets_from_map.heading_rad) * end.left_in_map;
  const Vector2 place_m = streets_from_map * scene.way.points[end.point].translation_m();
  equations.add_end(
      {node_m - middle_m, left, left.dot(place_m - node_m), {*end.node, *end.node}, 0.0});
}

}  // namespace

std::optional<std::size_t> StreetEvidence::link_at(const Pose2& streets_from_base) const {
  const auto nearest = field_.nearest(streets_from_base);
  if (!nearest || nearest->distance_m > kMostAcross_m) return std::nullopt;
  const double turn_rad =
      geometry::wrap_angle(streets_from_base.heading_rad - nearest->direction_rad);
  const Vector2 along{std::cos(nearest->direction_rad), std::sin(nearest->direction_rad)};
  const double beyond_m = along.dot(streets_from_base.translation_m() - nearest->point_m);
  if (std::abs(turn_rad) > kMostTurn_rad || std::abs(beyond_m) > kMostAlong_m) return std::nullopt;
  return nearest->part->link;
}

std::vector<Piece> StreetEvidence::pieces_at(const Pose2& streets_from_map,
                                             const std::vector<bool>& is_beside) const {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < way_.points.size(); ++i) {
    const int stretch = way_.stretches[i];
    if (stretch == DrivenWay::kTurn) continue;
    const auto link = is_beside[i] ? std::nullopt : link_at(streets_from_map * way_.points[i]);
    if (!pieces.empty() && pieces.back().stretch == stretch && pieces.back().link == link)
      pieces.back().last = i;
    else pieces.push_back({i, i, stretch, link});
  }
  std::erase_if(pieces,
                [](const Piece& piece) { return piece.link && piece.size() < kLeastPoints; });
  return pieces;
}

Explanation StreetEvidence::settled(Pose2 pose, const std::vector<bool>& is_beside) const {
  Explanation explanation;
  const Vector2 middle_in_map = way_.points[way_.points.size() / 2].translation_m();
  for (int step = 0; step < kSteps; ++step) {
    explanation.pieces = pieces_at(pose, is_beside);
    const SideExplanation sides = sides_.explain(pose, step == 0 ? kFirstSide_m : kSide_m);
    NormalEquations equations(prior_, network_, explanation.pieces, sides.matches);
    const Vector2 middle_m = pose * middle_in_map;
    for (const Piece& piece : explanation.pieces) {
      if (piece.link) add_piece(equations, {network_, field_, way_}, piece, pose, middle_m);
    }
    const MissingStreets missing = missing_streets(network_, way_, explanation.pieces, pose);
    for (const StreetEnd& end : missing.ends)
      add_end(equations, {network_, field_, way_}, end, pose, middle_m);
    for (const SideMatch& side : sides.matches) {
      const Vector2 place_m = pose * side.point_in_map;
      const Vector2 left = geometry::rotation(pose.heading_rad) * side.left_in_map;
      const Vector2 node_m = network_.nodes()[side.node].place_m;
      equations.add_side(
          {place_m - middle_m, left, left.dot(place_m - node_m), {side.node, side.node}, 0.0});
    }
    equations.solve(missing.costs, way_.points.size());
    explanation.cost = equations.cost() + sides.cost;
    explanation.squares = equations.squares();
    explanation.missing = missing.count;
    pose = equations.moved(pose, middle_m);
    if (equations.is_settled()) break;
  }
  explanation.streets_from_map = pose;
  std::size_t on_streets = 0;
  for (const Piece& piece : explanation.pieces) on_streets += piece.link ? piece.size() : 0;
  explanation.share = static_cast<double>(on_streets) / static_cast<double>(way_.points.size());
  return explanation;
}

Explanation StreetEvidence::explain(const Pose2& streets_from_map) const {
  return settled(streets_from_map, std::vector<bool>(way_.points.size(), false));
}

Explanation StreetEvidence::with_missing_streets(const Explanation& by_all_streets) const {
  std::vector<bool> is_beside(way_.points.size(), false);
  Explanation best = by_all_streets;
  for (int round = 0; round < kMostMissing; ++round) {
    Explanation better = best;
    std::vector<bool> is_beside_then;
    for (const Piece& piece : best.pieces) {
      if (!piece.link) continue;
      std::vector<bool> trial = is_beside;
      for (std::size_t i = piece.first; i <= piece.last; ++i) trial[i] = true;
      const Explanation other = settled(best.streets_from_map, trial);
      if (other.cost >= better.cost) continue;
      better = other;
      is_beside_then = trial;
    }
    if (is_beside_then.empty()) break;
    best = better;
    is_beside = is_beside_then;
  }
  return best;
}

Explanation StreetEvidence::beside_all_streets() const {
  Explanation explanation;
  explanation.pieces = pieces_at({}, std::vector<bool>(way_.points.size(), true));
  CostsBySigma costs = missing_streets(network_, way_, explanation.pieces, {}).costs;
  for (std::size_t k = 0; k < costs.size(); ++k)
    costs[k] +=
        kPointInformation * static_cast<double>(way_.points.size()) * std::log(kAcrossSigmas_m[k]);
  explanation.cost = mean_cost(costs) + sides_.cost_beside();
  return explanation;
}

}  // namespace slammot::streets
