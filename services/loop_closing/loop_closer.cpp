#include "services/loop_closing/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "common/graphs/path_uncertainty.hpp"

namespace slammot::loop_closing {
namespace {

using flow::Constraint;
using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

constexpr double kAnyHeading_rad = 1.0;              // one sigma
constexpr double kSameWithinSquaredSigmas = 11.3;  // chi-square, 3 degrees of freedom, 99 %

/// Largest standard deviation of the position in any direction.
double widest_sigma_m(const Matrix3& covariance) {
  const double half_trace = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half_difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(half_trace + std::hypot(half_difference, covariance(0, 1)));
}

/// A covariance that can be inverted, whatever the front end said.
Matrix3 with_floor(Matrix3 covariance) {
  constexpr double kPositionFloorM = 0.01;
  constexpr double kHeadingFloorRad = 0.001;
  covariance.diagonal() += Eigen::Vector3d(kPositionFloorM * kPositionFloorM, kPositionFloorM * kPositionFloorM, kHeadingFloorRad * kHeadingFloorRad);
  return covariance;
}

/// Whether the tie to the submap before says next to nothing, not even which way the vehicle looks.
bool has_gone_astray(const flow::Submap& submap) { return submap.previous_from_submap.covariance(2, 2) > kAnyHeading_rad * kAnyHeading_rad; }

Constraint loop_constraint(const Hypothesis& hypothesis) {
  return {hypothesis.from, hypothesis.to, ConstraintKind::kLoop, hypothesis.from_to};
}

}  // namespace

LoopCloser::LoopCloser(const LoopClosingConfig& config) : config_(config), graph_(config.graph), finder_(config.revisit) {}

flow::GraphCorrection LoopCloser::add(const flow::Submap& submap) {
  if (graph_.contains(submap.submap_id)) {
    ++counters_.repeated_submaps;
    return correction();
  }
  ++counters_.submaps;
  // How far it was carried nobody knows: it may be anywhere again.
  if (has_gone_astray(submap)) travelled_m_ += config_.min_travel_between_m;
  extend_graph(submap);
  const Place& source = places_.emplace(submap.submap_id, make_place(submap, travelled_m_, config_.place)).first->second;
  travelled_m_ += submap.travelled_m;
  look_for_revisits(source);
  close_what_is_firm();
  return correction();
}

void LoopCloser::extend_graph(const flow::Submap& submap) {
  if (places_.empty()) {
    graph_.add_node(submap.submap_id, submap.odom_from_submap);
    return;
  }
  const Place& previous = places_.rbegin()->second;
  // Where a submap in between was lost, odometry still tells where this one lies.
  const bool follows_directly = submap.submap_id.value == previous.id.value + 1;
  UncertainPose2 previous_from_submap = submap.previous_from_submap;
  if (!follows_directly) previous_from_submap.pose = geometry::inverse(previous.odom_from_submap) * submap.odom_from_submap;
  previous_from_submap.covariance = with_floor(previous_from_submap.covariance);
  graph_.add_node(submap.submap_id, graph_.map_from_node(previous.id) * previous_from_submap.pose);
  graph_.add_constraint({previous.id, submap.submap_id, ConstraintKind::kOdometric, previous_from_submap});
}

std::map<SubmapId, UncertainPose2> LoopCloser::expectations_from(SubmapId id) const {
  std::vector<Constraint> widened = graph_.constraints();
  const double scale = config_.odometry_sigma_scale * config_.odometry_sigma_scale;
  for (Constraint& constraint : widened) {
    if (constraint.kind == ConstraintKind::kOdometric) constraint.from_to.covariance *= scale;
  }
  auto expected = graphs::poses_along_best_paths(id, widened);
  // The path gives the uncertainty, the graph as a whole the pose.
  const Pose2 id_from_map = geometry::inverse(graph_.map_from_node(id));
  for (auto& [node, pose] : expected) pose.pose = id_from_map * graph_.map_from_node(node);
  return expected;
}

std::vector<LoopCloser::Candidate> LoopCloser::candidates_for(const Place& source) const {
  std::vector<Candidate> all;
  for (const auto& [id, source_from_target] : expectations_from(source.id)) {
    const Place& target = places_.at(id);
    if (source.travelled_before_m - target.travelled_after_m < config_.min_travel_between_m) continue;
    const double distance_m = (source_from_target.pose * target.middle_m - source.middle_m).norm();
    if (distance_m > config_.max_distance_m + config_.gate_sigmas * widest_sigma_m(source_from_target.covariance)) continue;
    all.push_back({id, geometry::inverse(source_from_target), distance_m});
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.distance_m < b.distance_m; });
  std::vector<Candidate> chosen;
  for (const Candidate& candidate : all) {
    if (static_cast<int>(chosen.size()) >= config_.max_candidates) break;
    // Neighbours of a chosen one are part of its target already.
    const bool is_covered = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& one) {
      return std::abs(static_cast<double>(one.id.value) - candidate.id.value) <= config_.neighbours;
    });
    if (!is_covered) chosen.push_back(candidate);
  }
  return chosen;
}

Target LoopCloser::target_around(SubmapId id, const Place& source) const {
  Target target{{{&places_.at(id), Pose2::identity()}}};
  const Pose2 target_from_map = geometry::inverse(graph_.map_from_node(id));
  for (int step = -config_.neighbours; step <= config_.neighbours; ++step) {
    const auto found = places_.find({static_cast<std::uint32_t>(static_cast<std::int64_t>(id.value) + step)});
    if (step == 0 || found == places_.end()) continue;
    if (source.travelled_before_m - found->second.travelled_after_m < config_.min_travel_between_m) continue;
    target.members.push_back({&found->second, target_from_map * graph_.map_from_node(found->first)});
  }
  return target;
}

void LoopCloser::look_for_revisits(const Place& source) {
  std::erase_if(waiting_, [&](const Hypothesis& one) {
    return one.to.value + static_cast<std::uint32_t>(config_.patience_submaps) < source.id.value;
  });
  for (const Candidate& candidate : candidates_for(source)) {
    ++counters_.searches;
    const auto found = finder_.find(target_around(candidate.id, source), source, candidate.target_from_source);
    if (found.empty()) continue;
    ++counters_.hypotheses;
    if (found.front().has_rivals) ++counters_.ambiguous;
    waiting_.insert(waiting_.end(), found.begin(), found.end());
  }
}

bool LoopCloser::agree(const Hypothesis& a, const Hypothesis& b) const {
  const Constraint between_earlier{a.from, b.from, ConstraintKind::kOdometric,
                                   {geometry::inverse(graph_.map_from_node(a.from)) * graph_.map_from_node(b.from), Matrix3::Zero()}};
  const Pose2 a_to_from_b_to = geometry::inverse(graph_.map_from_node(a.to)) * graph_.map_from_node(b.to);
  const UncertainPose2 to_to_by_both =
      geometry::compound(geometry::compound(geometry::inverse(a.from_to), between_earlier.from_to), b.from_to);
  return graphs::squared_error({a.to, b.to, ConstraintKind::kLoop, to_to_by_both}, Pose2::identity(), a_to_from_b_to) < kSameWithinSquaredSigmas;
}

int LoopCloser::support_of(const Hypothesis& hypothesis) const {
  std::set<SubmapId> supporters{hypothesis.to};
  for (const Hypothesis& other : waiting_) {
    if (other.to != hypothesis.to && agree(hypothesis, other)) supporters.insert(other.to);
  }
  return static_cast<int>(supporters.size());
}

int LoopCloser::needed_support_for(const Hypothesis& hypothesis) const {
  if (hypothesis.has_rivals) return config_.needed_when_ambiguous;
  return hypothesis.searched_sigma_m <= config_.sure_within_m ? 1 : config_.needed_support;
}

void LoopCloser::close_what_is_firm() {
  std::vector<Hypothesis> firm;
  for (const Hypothesis& hypothesis : waiting_) {
    const int support = support_of(hypothesis);
    if (support < needed_support_for(hypothesis)) continue;
    const bool has_equal_rival = std::any_of(waiting_.begin(), waiting_.end(), [&](const Hypothesis& other) {
      const bool is_rival = other.to == hypothesis.to && other.from == hypothesis.from && &other != &hypothesis;
      return is_rival && support_of(other) >= support;
    });
    if (!has_equal_rival) firm.push_back(hypothesis);
  }
  for (const Hypothesis& hypothesis : firm) {
    if (close(hypothesis)) {
      ++counters_.closures;
    } else {
      ++counters_.inconsistent;
    }
    std::erase_if(waiting_, [&](const Hypothesis& one) { return one.to == hypothesis.to && one.from == hypothesis.from; });
  }
}

bool LoopCloser::close(const Hypothesis& hypothesis) {
  const Constraint constraint = loop_constraint(hypothesis);
  Constraint widened = constraint;
  widened.from_to.covariance += expectations_from(hypothesis.from).at(hypothesis.to).covariance;
  const auto error = [&](const Constraint& one) {
    return graphs::squared_error(one, graph_.map_from_node(one.from), graph_.map_from_node(one.to));
  };
  if (error(widened) > config_.max_squared_error) return false;
  const graphs::PoseGraph before = graph_;
  graph_.add_constraint(constraint);
  graph_.optimise();
  ++counters_.optimisations;
  if (error(constraint) <= config_.max_squared_error) return true;
  graph_ = before;
  return false;
}

flow::GraphCorrection LoopCloser::correction() {
  const Place& newest = places_.rbegin()->second;
  return {.sequence = ++sequence_,
          .map_from_odom = graph_.map_from_node(newest.id) * geometry::inverse(newest.odom_from_submap),
          .submaps = graph_.nodes()};
}

}  // namespace slammot::loop_closing
