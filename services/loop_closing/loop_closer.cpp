#include "services/loop_closing/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <utility>

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

constexpr double kGateSigmas = 3.0;  // Gate of the graph's uncertainty, in addition to
                                     // max_distance_m.
constexpr int kNeighbours = 1;  // Submaps before and after the earlier one that join its target.
constexpr double kOdometrySigmaScale = 2.0;  // Factor on odometric sigmas in the gate:
                                             // docs/decisions/loop-closing.md.
constexpr int kSupportWaitSubmaps = 6;       // Submaps for which a hypothesis waits for support.
constexpr double kMaxSquaredError = 16.0;    // Chi-square of a closure against the graph before and
                                             // after it: docs/decisions/loop-closing.md.
constexpr int kMaxCandidatesElsewhere = 40;  // Targets on other islands for one new submap.

constexpr double kAnyHeading_rad = 1.0;  // Largest one-sigma error of a heading that is still
                                         // informative.
constexpr double kSamePlaceCells = 5.0;  // Greatest distance of poses of one place, in search
                                         // cells.
constexpr double kSamePlace_rad = 0.15;  // Greatest difference of headings of one place.
constexpr double kClearlyWorse = 2.0;  // Greatest contradicted share of a hypothesis, as a multiple
                                       // of the least one.
constexpr double kNoise_share = 0.01;  // Added to that limit.
constexpr int kMaxUnsolved = 10;       // Closures that the graph predicted, before the next solve.
constexpr double kSameWithinSquaredSigmas = 11.3;  // Chi-square, 3 degrees of freedom, 99 %.

/// Largest standard deviation of the position over all directions [m].
double widest_sigma_m(const Matrix3& covariance) {
  const double half_trace = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half_difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(half_trace + std::hypot(half_difference, covariance(0, 1)));
}

/// Adds a floor, so that a degenerate covariance from localization can be inverted.
Matrix3 with_floor(Matrix3 covariance) {
  constexpr double kPositionFloorM = 0.01;
  constexpr double kHeadingFloorRad = 0.001;
  covariance.diagonal() +=
      Eigen::Vector3d(kPositionFloorM * kPositionFloorM, kPositionFloorM * kPositionFloorM,
                      kHeadingFloorRad * kHeadingFloorRad);
  return covariance;
}

/// True if odometry does not determine even the heading relative to the submap before. Such a
/// submap begins an island.
bool begins_island(const flow::Submap& submap) {
  return submap.previous_from_submap.covariance(2, 2) > kAnyHeading_rad * kAnyHeading_rad;
}

bool is_finite(const Pose2& pose) {
  return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.heading_rad);
}

/// True if every number that the graph uses is finite.
bool is_sound(const flow::Submap& submap) {
  return is_finite(submap.odom_from_submap) && is_finite(submap.previous_from_submap.pose) &&
         submap.previous_from_submap.covariance.allFinite() &&
         is_finite(submap.submap_from_base_at_end) && std::isfinite(submap.travelled_m) &&
         std::all_of(submap.surfels.begin(), submap.surfels.end(), [](const flow::Surfel& surfel) {
           return std::isfinite(surfel.x_m) && std::isfinite(surfel.y_m) &&
                  std::isfinite(surfel.normal_x) && std::isfinite(surfel.normal_y);
         });
}

double quality_of(const Hypothesis& hypothesis) { return hypothesis.quality(); }
double contradicted_share_of(const Hypothesis& hypothesis) {
  return 1.0 - hypothesis.agreement.agreed_share();
}

/// Drops hypotheses clearly worse than the best one. In repetitive corridors most walls agree at
/// any pose, so that only contradictions distinguish the poses.
void drop_clearly_worse(std::vector<Hypothesis>& hypotheses, double rival_ratio) {
  const double best_quality = std::ranges::max(hypotheses, {}, quality_of).quality();
  std::erase_if(hypotheses,
                [&](const Hypothesis& one) { return one.quality() < rival_ratio * best_quality; });
  const double least_contradicted =
      contradicted_share_of(std::ranges::min(hypotheses, {}, contradicted_share_of));
  std::erase_if(hypotheses, [&](const Hypothesis& one) {
    return contradicted_share_of(one) > kClearlyWorse * least_contradicted + kNoise_share;
  });
}

/// Prior of a target on another island: centres coincide, sigma_m in position, any heading.
UncertainPose2 unknown_pose_on(const Place& target, const Place& source, double sigma_m) {
  const Vector2 shift_m = target.centre_m - source.centre_m;
  return {{shift_m.x(), shift_m.y(), 0.0},
          Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, std::numbers::pi * std::numbers::pi)
              .asDiagonal()};
}

Constraint loop_constraint(const Hypothesis& hypothesis) {
  return {hypothesis.from, hypothesis.to, ConstraintKind::kLoop, hypothesis.from_to};
}

}  // namespace

LoopCloser::LoopCloser(const LoopClosingConfig& config)
    : config_(config), graph_(config.graph), searches_(config.search) {}

flow::GraphCorrection LoopCloser::add(const flow::Submap& submap) {
  if (graph_.contains(submap.submap_id)) {
    ++counters_.repeated_submaps;
    return correction();
  }
  if (!is_sound(submap)) {
    ++counters_.faulty_submaps;
    return correction();
  }
  ++counters_.submaps;
  // The distance of the gap is unknown: the submap may show any earlier place.
  if (begins_island(submap)) travelled_m_ += config_.min_travel_between_m;
  extend_graph(submap);
  const Place& source =
      places_.emplace(submap.submap_id, make_place(submap, travelled_m_, config_.place))
          .first->second;
  travelled_m_ += submap.travelled_m;
  begin_searches(source);
  for (const SearchQueue::Finished& search : searches_.advance()) take(search);
  close_supported();
  return correction();
}

flow::GraphCorrection LoopCloser::finish() {
  for (const SearchQueue::Finished& search : searches_.finish()) {
    take(search);
    close_supported();
  }
  solve_deferred();
  return correction();
}

void LoopCloser::add_constraint(const Constraint& constraint) {
  graph_.add_constraint(constraint);
  add_to_islands(constraint);
}

void LoopCloser::add_to_islands(const Constraint& constraint) {
  const SubmapId a = island_of_.at(constraint.from);
  const SubmapId b = island_of_.at(constraint.to);
  if (a == b) return;
  for (auto& [id, island] : island_of_) {
    if (island == std::max(a, b)) island = std::min(a, b);
  }
}

void LoopCloser::extend_graph(const flow::Submap& submap) {
  if (places_.empty()) {
    graph_.add_node(submap.submap_id, submap.odom_from_submap);
    island_of_.emplace(submap.submap_id, submap.submap_id);
    return;
  }
  const Place& previous = places_.rbegin()->second;
  // After a missing submap the poses in odom still give the relative pose.
  const bool follows_directly = submap.submap_id.value == previous.id.value + 1;
  UncertainPose2 previous_from_submap = submap.previous_from_submap;
  if (!follows_directly)
    previous_from_submap.pose =
        geometry::inverse(previous.odom_from_submap) * submap.odom_from_submap;
  previous_from_submap.covariance = with_floor(previous_from_submap.covariance);
  graph_.add_node(submap.submap_id, graph_.map_from_node(previous.id) * previous_from_submap.pose);
  island_of_.emplace(submap.submap_id, submap.submap_id);
  // Even a weak constraint would pull if it is wrong by a kilometre.
  if (begins_island(submap)) return;
  add_constraint({previous.id, submap.submap_id, ConstraintKind::kOdometric, previous_from_submap});
}

std::map<SubmapId, UncertainPose2> LoopCloser::expectations_from(SubmapId id) const {
  std::vector<Constraint> widened = active_constraints();
  const double scale = kOdometrySigmaScale * kOdometrySigmaScale;
  for (Constraint& constraint : widened) {
    if (constraint.kind == ConstraintKind::kOdometric) constraint.from_to.covariance *= scale;
  }
  auto expected = graphs::poses_along_best_paths(id, widened);
  // Covariance along the best path; mean from the optimized graph.
  const Pose2 id_from_map = geometry::inverse(graph_.map_from_node(id));
  for (auto& [node, pose] : expected) pose.pose = id_from_map * graph_.map_from_node(node);
  return expected;
}

std::vector<LoopCloser::Candidate> LoopCloser::candidates_for(const Place& source) const {
  std::vector<Candidate> all;
  for (const auto& [id, source_from_target] : expectations_from(source.id)) {
    const Place& target = places_.at(id);
    if (source.travelled_before_m - target.travelled_after_m < config_.min_travel_between_m)
      continue;
    const double distance_m = (source_from_target.pose * target.centre_m - source.centre_m).norm();
    if (distance_m >
        config_.max_distance_m + kGateSigmas * widest_sigma_m(source_from_target.covariance))
      continue;
    all.push_back({id, geometry::inverse(source_from_target), distance_m});
  }
  return nearest(std::move(all), config_.max_candidates);
}

/// The nearest candidates. Neighbours of a chosen candidate are part of its target.
std::vector<LoopCloser::Candidate> LoopCloser::nearest(std::vector<Candidate> all, int most) const {
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance_m < b.distance_m;
  });
  std::vector<Candidate> chosen;
  for (const Candidate& candidate : all) {
    if (static_cast<int>(chosen.size()) >= most) break;
    const bool is_covered = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& one) {
      return std::abs(static_cast<double>(one.id.value) - candidate.id.value) <= kNeighbours;
    });
    if (!is_covered) chosen.push_back(candidate);
  }
  return chosen;
}

/// Targets on other islands, nearest first by the last known position of the vehicle.
std::vector<LoopCloser::Candidate> LoopCloser::candidates_elsewhere_for(const Place& source) const {
  const Vector2 source_in_map_m = graph_.map_from_node(source.id) * source.centre_m;
  std::vector<Candidate> all;
  for (const auto& [id, target] : places_) {
    if (island_of_.at(id) == island_of_.at(source.id)) continue;
    all.push_back({id, unknown_pose_on(target, source, config_.max_distance_m),
                   (graph_.map_from_node(id) * target.centre_m - source_in_map_m).norm()});
  }
  return nearest(std::move(all), kMaxCandidatesElsewhere);
}

Target LoopCloser::target_around(SubmapId id, const Place& source) const {
  Target target{{{&places_.at(id), Pose2::identity()}}};
  const Pose2 target_from_map = geometry::inverse(graph_.map_from_node(id));
  for (int step = -kNeighbours; step <= kNeighbours; ++step) {
    const auto found =
        places_.find({static_cast<std::uint32_t>(static_cast<std::int64_t>(id.value) + step)});
    if (step == 0 || found == places_.end() || island_of_.at(found->first) != island_of_.at(id))
      continue;
    if (source.travelled_before_m - found->second.travelled_after_m < config_.min_travel_between_m)
      continue;
    target.members.push_back(
        {&found->second, target_from_map * graph_.map_from_node(found->first)});
  }
  return target;
}

void LoopCloser::begin_searches(const Place& source) {
  for (const Candidate& candidate : candidates_for(source)) {
    ++counters_.searches;
    searches_.add({config_.revisit, source, {revisit_candidate(candidate, source)}},
                  SearchQueue::Extent::kExpected);
  }
  std::vector<RevisitCandidate> elsewhere;
  for (const Candidate& candidate : candidates_elsewhere_for(source))
    elsewhere.push_back(revisit_candidate(candidate, source));
  if (elsewhere.empty()) return;
  counters_.searches += elsewhere.size();
  searches_.add({config_.revisit, source, std::move(elsewhere)}, SearchQueue::Extent::kEverywhere);
}

RevisitCandidate LoopCloser::revisit_candidate(const Candidate& candidate,
                                               const Place& source) const {
  return {target_around(candidate.id, source), candidate.target_from_source,
          graph_.map_from_node(candidate.id)};
}

void LoopCloser::take(const SearchQueue::Finished& search) {
  counters_.searches_given_up = searches_.given_up();
  counters_.search_work = searches_.work();
  std::erase_if(waiting_, [&](const Hypothesis& one) {
    return one.to.value + static_cast<std::uint32_t>(kSupportWaitSubmaps) < search.source.value;
  });
  std::vector<Hypothesis> found = search.hypotheses;
  if (found.empty() && !search.is_given_up && search.extent == SearchQueue::Extent::kExpected)
    check_contradiction(search);
  if (found.empty()) return;
  ++counters_.hypotheses;
  // Distant places may look alike: hypotheses on all targets compete.
  if (search.extent == SearchQueue::Extent::kEverywhere) {
    drop_clearly_worse(found, config_.revisit.rival_ratio);
    for (Hypothesis& one : found) {
      one.has_rivals = std::any_of(found.begin(), found.end(),
                                   [&](const Hypothesis& other) { return are_rivals(one, other); });
    }
  }
  if (search.is_given_up) {
    for (Hypothesis& one : found) one.has_rivals = true;
  }
  if (std::any_of(found.begin(), found.end(), [](const Hypothesis& one) { return one.has_rivals; }))
    ++counters_.ambiguous;
  waiting_.insert(waiting_.end(), found.begin(), found.end());
}

/// True if both place one submap on one island, at different poses.
bool LoopCloser::are_rivals(const Hypothesis& a, const Hypothesis& b) const {
  if (a.to != b.to || island_of_.at(a.from) != island_of_.at(b.from)) return false;
  const Eigen::Vector3d apart = geometry::difference(graph_.map_from_node(a.from) * a.from_to.pose,
                                                     graph_.map_from_node(b.from) * b.from_to.pose);
  return apart.head<2>().norm() > kSamePlaceCells * config_.revisit.search_cell_m ||
         std::abs(apart.z()) > kSamePlace_rad;
}

/// Covariance of the relative pose of two submaps of one drive, by a drift model: two correct
/// hypotheses differ by this drift.
Matrix3 LoopCloser::drift_between(SubmapId a, SubmapId b) const {
  constexpr double kDriftShare = 0.02;     // Sigma of the position as a share of the distance.
  constexpr double kDrift_radpm = 0.0005;  // Sigma of the heading by distance [rad/m].
  const double way_m =
      std::abs(places_.at(a).travelled_before_m - places_.at(b).travelled_before_m);
  return Eigen::Vector3d(kDriftShare * way_m, kDriftShare * way_m, kDrift_radpm * way_m)
      .cwiseAbs2()
      .asDiagonal();
}

bool LoopCloser::agree(const Hypothesis& a, const Hypothesis& b) const {
  const UncertainPose2 between_earlier{
      geometry::inverse(graph_.map_from_node(a.from)) * graph_.map_from_node(b.from),
      drift_between(a.from, b.from)};
  const Pose2 a_to_from_b_to =
      geometry::inverse(graph_.map_from_node(a.to)) * graph_.map_from_node(b.to);
  UncertainPose2 to_to_by_both = geometry::compound(
      geometry::compound(geometry::inverse(a.from_to), between_earlier), b.from_to);
  to_to_by_both.covariance += drift_between(a.to, b.to);
  return graphs::squared_error({a.to, b.to, ConstraintKind::kLoop, to_to_by_both},
                               Pose2::identity(), a_to_from_b_to) < kSameWithinSquaredSigmas;
}

int LoopCloser::support_of(const Hypothesis& hypothesis) const {
  std::set<SubmapId> supporters{hypothesis.to};
  for (const Hypothesis& other : waiting_) {
    const bool is_comparable = island_of_.at(other.to) == island_of_.at(hypothesis.to) &&
                               island_of_.at(other.from) == island_of_.at(hypothesis.from);
    if (other.to != hypothesis.to && is_comparable && agree(hypothesis, other))
      supporters.insert(other.to);
  }
  return static_cast<int>(supporters.size());
}

int LoopCloser::needed_support_for(const Hypothesis& hypothesis) const {
  if (hypothesis.has_rivals) return config_.needed_when_ambiguous;
  return hypothesis.searched_sigma_m <= config_.sure_within_m ? 1 : config_.needed_support;
}

void LoopCloser::close_supported() {
  std::vector<Hypothesis> supported;
  for (const Hypothesis& hypothesis : waiting_) {
    if (hypothesis.agreement.agreed_share() < config_.revisit.min_agreed_share)
      continue;  // Too weak for a closure; it still supports others.
    const int support = support_of(hypothesis);
    if (support < needed_support_for(hypothesis)) continue;
    const bool has_supported_rival =
        std::any_of(waiting_.begin(), waiting_.end(), [&](const Hypothesis& other) {
          // A hypothesis on another island must be the only one with support.
          const bool is_found_elsewhere =
              island_of_.at(hypothesis.from) != island_of_.at(hypothesis.to);
          if (is_found_elsewhere)
            return are_rivals(hypothesis, other) &&
                   support_of(other) >= std::min(support, config_.needed_support);
          const bool is_rival =
              other.to == hypothesis.to && other.from == hypothesis.from && &other != &hypothesis;
          return is_rival && support_of(other) >= support;
        });
    if (!has_supported_rival) supported.push_back(hypothesis);
  }
  for (const Hypothesis& hypothesis : supported) {
    if (close(hypothesis)) {
      ++counters_.closures;
    } else {
      ++counters_.inconsistent;
    }
    std::erase_if(waiting_, [&](const Hypothesis& one) {
      return one.to == hypothesis.to && one.from == hypothesis.from;
    });
  }
}

/// Moves the whole later island: the first submap defines the frame map.
void LoopCloser::join_islands(const Hypothesis& hypothesis) {
  const bool to_moves = island_of_.at(hypothesis.from) < island_of_.at(hypothesis.to);
  const Pose2 map_from_from = graph_.map_from_node(hypothesis.from);
  const Pose2 map_from_to = graph_.map_from_node(hypothesis.to);
  const Pose2 shift = to_moves
                          ? map_from_from * hypothesis.from_to.pose * geometry::inverse(map_from_to)
                          : map_from_to * geometry::inverse(hypothesis.from_to.pose) *
                                geometry::inverse(map_from_from);
  const SubmapId moving = island_of_.at(to_moves ? hypothesis.to : hypothesis.from);
  for (const auto& [id, island] : island_of_) {
    if (island == moving) graph_.move_node(id, shift * graph_.map_from_node(id));
  }
}

bool LoopCloser::close(const Hypothesis& hypothesis) {
  const Constraint constraint = loop_constraint(hypothesis);
  const bool joins = island_of_.at(hypothesis.from) != island_of_.at(hypothesis.to);
  if (!joins && can_defer_solving(constraint)) {
    propose(hypothesis);
    if (++unsolved_ >= kMaxUnsolved) solve_deferred();
    return true;
  }
  unsolved_ = 0;
  const graphs::PoseGraph before = graph_;
  const Islands islands_before = island_of_;
  if (joins) {
    join_islands(hypothesis);
  } else {
    Constraint widened = constraint;
    widened.from_to.covariance += expectations_from(hypothesis.from).at(hypothesis.to).covariance;
    // The graph may be wrong: with enough agreeing submaps a closure may contradict it.
    if (error_of(widened) > kMaxSquaredError &&
        support_of(hypothesis) < config_.needed_when_ambiguous) {
      reject(hypothesis, error_of(widened), "contradicts the graph by more than its uncertainty");
      return false;
    }
  }
  const bool is_first_of_group =
      std::ranges::none_of(closures_, [group = group_for(constraint)](const Closure& one) {
        return one.group == group && one.constraint.verdict.state == flow::ClosureState::kAccepted;
      });
  propose(hypothesis);
  if (!joins) {
    graph_.optimise();
    ++counters_.optimisations;
    exclude_costliest_closures(before);
  }
  const double weight = graph_.weight(closures_.back().edge);
  if (weight >= 0.5 && is_first_of_group && preceding_submaps_contradict(hypothesis)) {
    graph_ = before;
    island_of_ = islands_before;
    closures_.pop_back();
    reject(hypothesis, error_of(constraint), "preceding submaps would contradict the map");
    return false;
  }
  if (joins) ++counters_.found_elsewhere;
  update_verdicts("outweighed by closure " + std::to_string(hypothesis.from.value) + " - " +
                  std::to_string(hypothesis.to.value));
  if (weight < 0.5) return false;
  for (const int group : groups_between(hypothesis.from, hypothesis.to))
    ++groups_[group].confirmations;
  return true;
}

/// In a large graph, a closure that the graph predicts within the closure's covariance hardly moves
/// a node: solving is deferred.
bool LoopCloser::can_defer_solving(const Constraint& constraint) const {
  constexpr std::size_t kLargeGraph = 100;  // nodes
  constexpr double kPredictedSquaredError = 1.0;
  return places_.size() > kLargeGraph && error_of(constraint) < kPredictedSquaredError;
}

void LoopCloser::solve_deferred() {
  if (unsolved_ == 0) return;
  unsolved_ = 0;
  graph_.optimise();
  ++counters_.optimisations;
  update_verdicts("outweighed by later closures");
}

int LoopCloser::group_for(const Constraint& constraint) {
  const auto is_near = [&](SubmapId a, SubmapId b) {
    return std::abs(static_cast<double>(a.value) - b.value) <= kSupportWaitSubmaps;
  };
  const auto known = std::ranges::find_if(closures_, [&](const Closure& one) {
    return one.constraint.verdict.state == flow::ClosureState::kAccepted &&
           is_near(one.constraint.from, constraint.from) &&
           is_near(one.constraint.to, constraint.to);
  });
  return known != closures_.end() ? known->group : static_cast<int>(closures_.size());
}

/// Adds the closure to the graph and re-enables excluded closures that agree with it.
LoopCloser::Closure& LoopCloser::propose(const Hypothesis& hypothesis) {
  for (Closure& dropped : closures_) {
    const bool is_dropped = dropped.constraint.verdict.state != flow::ClosureState::kAccepted;
    if (is_dropped && agree(hypothesis, {.from = dropped.constraint.from,
                                         .to = dropped.constraint.to,
                                         .from_to = dropped.constraint.from_to,
                                         .agreement = {}}))
      graph_.set_enabled(dropped.edge, true);
  }
  Constraint constraint = loop_constraint(hypothesis);
  const int group = group_for(constraint);
  constraint.verdict = {flow::ClosureState::kAccepted, error_of(constraint),
                        hypothesis.agreement.agreed_share(),
                        "supported by " + std::to_string(support_of(hypothesis)) + " submaps"};
  add_constraint(constraint);
  closures_.push_back({constraint, graph_.constraints().size() - 1, group});
  groups_.try_emplace(group);
  return closures_.back();
}

void LoopCloser::reject(const Hypothesis& hypothesis, double squared_error, std::string reason) {
  Constraint constraint = loop_constraint(hypothesis);
  constraint.verdict = {flow::ClosureState::kRejected, squared_error,
                        hypothesis.agreement.agreed_share(), std::move(reason)};
  rejected_.push_back(constraint);
}

/// Contradictory closures are more certain than odometry: instead of showing large errors of their
/// own, they distort odometric constraints. If the newest closure, with those that it re-enabled,
/// raises the cost by more than the price of excluding a closure, takes the cheapest alternative:
/// exclude these, or one of the latest groups (truncated least squares over groups).
void LoopCloser::exclude_costliest_closures(const graphs::PoseGraph& before) {
  constexpr std::size_t kMostGroups = 3;
  const double price = kMaxSquaredError;
  const auto cost_of = [&](const graphs::PoseGraph& graph) {
    return graph.truncated_cost(kOdometrySigmaScale);
  };
  if (cost_of(graph_) <= cost_of(before) + price) return;
  std::vector<std::size_t> new_edges{closures_.back().edge};
  for (const Closure& closure : closures_) {
    if (closure.edge != new_edges.front() && before.weight(closure.edge) < 0.5 &&
        graph_.weight(closure.edge) >= 0.5)
      new_edges.push_back(closure.edge);
  }
  double least_cost = cost_of(before) + price * static_cast<double>(new_edges.size());
  graphs::PoseGraph best = before;
  for (const Constraint& constraint :
       std::span(graph_.constraints()).subspan(before.constraints().size()))
    best.add_constraint(constraint);
  for (const std::size_t edge : new_edges) best.set_enabled(edge, false);
  std::set<int> tried;
  for (auto closure = closures_.rbegin() + 1;
       closure != closures_.rend() && tried.size() < kMostGroups; ++closure) {
    const int group = closure->group;
    if (group == closures_.back().group || graph_.weight(closure->edge) < 0.5 ||
        !tried.insert(group).second)
      continue;
    graphs::PoseGraph without = graph_;
    std::size_t left_out = 0;
    for (const Closure& one : closures_) {
      if (one.group != group || without.weight(one.edge) < 0.5) continue;
      without.set_enabled(one.edge, false);
      ++left_out;
    }
    without.optimise();
    ++counters_.optimisations;
    const double cost = cost_of(without) + price * static_cast<double>(left_out);
    if (cost >= least_cost) continue;
    least_cost = cost;
    best = without;
  }
  graph_ = best;
}

/// Sets the state of each closure from its weight in the graph.
void LoopCloser::update_verdicts(const std::string& reason) {
  bool has_changed = false;
  for (Closure& closure : closures_) {
    flow::ClosureVerdict& verdict = closure.constraint.verdict;
    const flow::ClosureState before = verdict.state;
    const bool counts = graph_.weight(closure.edge) >= 0.5;
    const bool is_newest = &closure == &closures_.back();
    if (counts) {
      if (verdict.state != flow::ClosureState::kAccepted) {
        verdict.reason = "agrees with the graph again";
        ++counters_.came_back;
      }
      verdict.state = flow::ClosureState::kAccepted;
      verdict.squared_error = error_of(closure.constraint);
    } else if (verdict.state == flow::ClosureState::kAccepted && is_newest) {
      verdict.state = flow::ClosureState::kRejected;
      verdict.squared_error = error_of(closure.constraint);
      verdict.reason = "distorts the graph by more than its uncertainty";
      graph_.set_enabled(closure.edge, false);
    } else if (verdict.state == flow::ClosureState::kAccepted) {
      withdraw(closure, reason);
    } else {
      graph_.set_enabled(closure.edge, false);
    }
    has_changed = has_changed || verdict.state != before;
  }
  if (has_changed) island_of_ = islands(graph_.nodes(), active_constraints());
}

void LoopCloser::withdraw(Closure& closure, std::string reason) {
  closure.constraint.verdict = {flow::ClosureState::kWithdrawn, error_of(closure.constraint),
                                closure.constraint.verdict.agreed_share, std::move(reason)};
  graph_.set_enabled(closure.edge, false);
  ++counters_.withdrawn;
}

/// Counts a contradiction where the graph is certain that a submap lies on another and their walls
/// disagree: some closure on the path between both is wrong. Withdraws the weakest group on the
/// path after repeated contradictions.
void LoopCloser::check_contradiction(const SearchQueue::Finished& search) {
  constexpr int kMaxContradictions = 2;
  if (search.searched_sigma_m > config_.sure_within_m ||
      island_of_.at(search.source) != island_of_.at(search.target))
    return;
  if (!contradicts(search.target, places_.at(search.source))) return;
  ++counters_.contradictions;
  const std::vector<int> between = groups_between(search.source, search.target);
  if (between.empty()) return;
  const int weakest = std::ranges::min(between, {}, [&](int group) {
    return groups_[group].confirmations - groups_[group].contradictions;
  });
  ClosureGroup& group = groups_[weakest];
  if (++group.contradictions < kMaxContradictions ||
      group.contradictions <= 2 * group.confirmations)
    return;
  for (Closure& closure : closures_) {
    if (closure.group == weakest &&
        closure.constraint.verdict.state == flow::ClosureState::kAccepted) {
      withdraw(closure, "contradicted by submap " + std::to_string(search.source.value) +
                            " at the pose that this implies");
    }
  }
  group = {};
  island_of_ = islands(graph_.nodes(), active_constraints());
  graph_.optimise();
  ++counters_.optimisations;
}

/// True if the source, after registration, has walls in free space of the target or the reverse.
bool LoopCloser::contradicts(SubmapId target_id, const Place& source) const {
  constexpr double kMostAgreedShare = 0.6;
  constexpr double kLeastComparedShare = 0.4;  // Share of the source's walls that must be
                                               // comparable.
  const Target target = target_around(target_id, source);
  const Pose2 target_from_source =
      geometry::inverse(graph_.map_from_node(target_id)) * graph_.map_from_node(source.id);
  const Agreement agreement =
      agreement_after_refining(config_.revisit, target, source, target_from_source);
  return agreement.occupied_in_both + agreement.contradicted >
             kLeastComparedShare * agreement.source_walls &&
         agreement.agreed_share() < kMostAgreedShare;
}

/// True if at least half of the submaps just before the located one contradict the map at the poses
/// that the closure implies.
bool LoopCloser::preceding_submaps_contradict(const Hypothesis& hypothesis) const {
  constexpr std::uint32_t kBefore = 3;
  int compared = 0;
  int contradicting = 0;
  for (std::uint32_t step = 1; step <= kBefore && step <= hypothesis.to.value; ++step) {
    const auto found = places_.find({hypothesis.to.value - step});
    if (found == places_.end() || island_of_.at(found->first) != island_of_.at(hypothesis.from))
      continue;
    const Place& source = found->second;
    const Vector2 in_map_m = graph_.map_from_node(source.id) * source.centre_m;
    const Place* nearest_place = nullptr;
    double nearest_m = 0.5 * config_.max_distance_m;
    for (const auto& [id, place] : places_) {
      if (source.travelled_before_m - place.travelled_after_m < config_.min_travel_between_m ||
          island_of_.at(id) != island_of_.at(source.id))
        continue;
      const double distance_m = (graph_.map_from_node(id) * place.centre_m - in_map_m).norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      nearest_place = &place;
    }
    if (nearest_place == nullptr) continue;
    ++compared;
    if (contradicts(nearest_place->id, source)) ++contradicting;
  }
  return contradicting > 0 && 2 * contradicting >= compared;
}

std::vector<int> LoopCloser::groups_between(SubmapId a, SubmapId b) const {
  const std::vector<Constraint> active = active_constraints();
  std::set<int> groups;
  for (const std::size_t step : graphs::best_path(a, b, active)) {
    if (active[step].kind == ConstraintKind::kOdometric) continue;
    const auto closure = std::ranges::find_if(closures_, [&](const Closure& one) {
      return one.constraint.from == active[step].from && one.constraint.to == active[step].to;
    });
    if (closure != closures_.end()) groups.insert(closure->group);
  }
  return {groups.begin(), groups.end()};
}

std::vector<Constraint> LoopCloser::active_constraints() const {
  std::vector<Constraint> active;
  for (std::size_t i = 0; i < graph_.constraints().size(); ++i) {
    if (graph_.weight(i) >= 0.5) active.push_back(graph_.constraints()[i]);
  }
  return active;
}

std::vector<Constraint> LoopCloser::constraints() const {
  std::vector<Constraint> all;
  for (const Constraint& constraint : graph_.constraints()) {
    if (constraint.kind == ConstraintKind::kOdometric) all.push_back(constraint);
  }
  std::map<std::pair<SubmapId, SubmapId>, const Constraint*> loops;
  for (const Constraint& constraint : rejected_)
    loops[{constraint.from, constraint.to}] = &constraint;
  for (const Closure& closure : closures_)
    loops[{closure.constraint.from, closure.constraint.to}] = &closure.constraint;
  for (const auto& [ends, constraint] : loops) all.push_back(*constraint);
  return all;
}

bool LoopCloser::is_connected() const {
  return places_.empty() || island_of_.at(places_.rbegin()->first) == places_.begin()->first;
}

flow::GraphCorrection LoopCloser::correction() {
  flow::GraphCorrection correction;
  correction.sequence = ++sequence_;
  if (places_.empty()) return correction;
  const Place& newest = places_.rbegin()->second;
  correction.map_from_odom =
      graph_.map_from_node(newest.id) * geometry::inverse(newest.odom_from_submap);
  correction.submaps = graph_.nodes();
  correction.is_untied = !is_connected();
  return correction;
}

}  // namespace slammot::loop_closing
