#include "services/loop_closing/support.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include "common/graphs/pose_graph.hpp"
#include "services/loop_closing/hypotheses.hpp"

namespace slammot::loop_closing {
namespace {

using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;

constexpr double kSamePlaceCells = 5.0;  // Greatest distance of poses of one place, in search
                                         // cells.
constexpr double kSamePlace_rad = 0.15;  // Greatest difference of headings of one place.

/// Covariance of the relative pose of two submaps of one drive, by a drift model: two correct
/// hypotheses differ by this drift.
Matrix3 drift_between(const Places& places, SubmapId a, SubmapId b) {
  constexpr double kDriftShare = 0.02;     // Sigma of the position as a share of the distance.
  constexpr double kDrift_radpm = 0.0005;  // Sigma of the heading by distance [rad/m].
  const double way_m = std::abs(places.at(a).travelled_before_m - places.at(b).travelled_before_m);
  return Eigen::Vector3d(kDriftShare * way_m, kDriftShare * way_m, kDrift_radpm * way_m)
      .cwiseAbs2()
      .asDiagonal();
}

/// True if both relate the same two islands.
bool are_comparable(const ClosureGraph& graph, const Hypothesis& a, const Hypothesis& b) {
  return graph.are_on_one_island(a.to, b.to) && graph.are_on_one_island(a.from, b.from);
}

}  // namespace

flow::Constraint closure_of(const Hypothesis& hypothesis) {
  flow::Constraint closure{hypothesis.from, hypothesis.to, ConstraintKind::kLoop,
                           hypothesis.from_to};
  closure.verdict.agreed_share = hypothesis.agreement.agreed_share();
  return closure;
}

bool agree(const SubmapView& submaps, const Hypothesis& a, const Hypothesis& b) {
  const auto& [config, places, graph, gnss_is_sound] = submaps;
  const UncertainPose2 between_earlier{
      geometry::inverse(graph.map_from_node(a.from)) * graph.map_from_node(b.from),
      drift_between(places, a.from, b.from)};
  const Pose2 a_to_from_b_to =
      geometry::inverse(graph.map_from_node(a.to)) * graph.map_from_node(b.to);
  UncertainPose2 to_to_by_both = geometry::compound(
      geometry::compound(geometry::inverse(a.from_to), between_earlier), b.from_to);
  to_to_by_both.covariance += drift_between(places, a.to, b.to);
  return graphs::squared_error({a.to, b.to, ConstraintKind::kLoop, to_to_by_both},
                               Pose2::identity(), a_to_from_b_to) < kSameWithinSquaredSigmas;
}

bool are_rivals(const SubmapView& submaps, const Hypothesis& a, const Hypothesis& b) {
  const ClosureGraph& graph = submaps.graph;
  if (a.to != b.to || !graph.are_on_one_island(a.from, b.from)) return false;
  const Eigen::Vector3d apart = geometry::difference(graph.map_from_node(a.from) * a.from_to.pose,
                                                     graph.map_from_node(b.from) * b.from_to.pose);
  return apart.head<2>().norm() > kSamePlaceCells * search_cell_m(submaps.places.at(a.to)) ||
         std::abs(apart.z()) > kSamePlace_rad;
}

void select_on_one_island(const SubmapView& submaps, double rival_ratio, SubmapId to,
                          std::vector<Hypothesis>& all) {
  const auto competes = [&](const Hypothesis& one) {
    return one.to == to && submaps.graph.are_on_one_island(one.from, to);
  };
  const auto is_elsewhere = [&](const Hypothesis& one, const Hypothesis& other) {
    return one.from != other.from && !agree(submaps, one, other);
  };
  std::vector<Hypothesis> competing;
  std::ranges::copy_if(all, std::back_inserter(competing), competes);
  std::erase_if(all, [&](const Hypothesis& one) {
    return competes(one) && std::ranges::any_of(competing, [&](const Hypothesis& other) {
             return is_more_contradicted(one, other) && is_elsewhere(one, other);
           });
  });
  for (Hypothesis& one : all) {
    if (!competes(one)) continue;
    double elsewhere = 0.0;
    for (const Hypothesis& other : all) {
      if (&other == &one || !competes(other) || agree(submaps, one, other)) continue;
      elsewhere += other.quality();
      one.has_rivals = one.has_rivals || other.quality() >= rival_ratio * one.quality();
    }
    one.certainty = one.quality() / (one.quality() + elsewhere);
  }
}

double support_of(const SubmapView& submaps, const std::vector<Hypothesis>& all,
                  const Hypothesis& hypothesis) {
  std::map<SubmapId, double> certainties{{hypothesis.to, 1.0}};
  for (const Hypothesis& other : all) {
    if (other.to == hypothesis.to || !are_comparable(submaps.graph, hypothesis, other) ||
        !agree(submaps, hypothesis, other))
      continue;
    double& certainty = certainties[other.to];
    certainty = std::max(certainty, other.certainty);
  }
  const auto add = [](double sum, const auto& one) { return sum + one.second; };
  return std::accumulate(certainties.begin(), certainties.end(), 0.0, add);
}

std::vector<Hypothesis> consistent_set(const SubmapView& submaps,
                                       const std::vector<Hypothesis>& all,
                                       const Hypothesis& hypothesis) {
  std::vector<Hypothesis> best_first = all;
  std::ranges::stable_sort(best_first, std::ranges::greater(), &Hypothesis::quality);
  std::vector<Hypothesis> set{hypothesis};
  for (const Hypothesis& other : best_first) {
    if (!are_comparable(submaps.graph, hypothesis, other)) continue;
    const bool fits = std::ranges::all_of(set, [&](const Hypothesis& one) {
      return one.to != other.to && agree(submaps, one, other);
    });
    if (fits) set.push_back(other);
  }
  return set;
}

double error_with_graph_uncertainty(const ClosureGraph& graph, const flow::Constraint& closure) {
  flow::Constraint widened = closure;
  widened.from_to.covariance += graph.expectations_from(closure.from).at(closure.to).covariance;
  return graph.error_of(widened);
}

}  // namespace slammot::loop_closing
