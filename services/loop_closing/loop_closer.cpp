#include "services/loop_closing/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "services/loop_closing/contradictions.hpp"
#include "services/loop_closing/submap_odometry.hpp"

namespace slammot::loop_closing {
namespace {

using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;

constexpr int kSupportWaitSubmaps = 6;   // Submaps for which a hypothesis waits for support.
constexpr double kSamePlaceCells = 5.0;  // Greatest distance of poses of one place, in search
                                         // cells.
constexpr double kSamePlace_rad = 0.15;  // Greatest difference of headings of one place.
constexpr int kMaxUnsolved = 10;  // Closures that the graph predicted, before the next solve.
constexpr double kSameWithinSquaredSigmas = 11.3;  // Chi-square, 3 degrees of freedom, 99 %.

flow::Constraint closure_of(const Hypothesis& hypothesis) {
  flow::Constraint closure{hypothesis.from, hypothesis.to, ConstraintKind::kLoop,
                           hypothesis.from_to};
  closure.verdict.agreed_share = hypothesis.agreement.agreed_share();
  return closure;
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

void LoopCloser::extend_graph(const flow::Submap& submap) {
  if (places_.empty()) {
    graph_.add_node(submap.submap_id, submap.odom_from_submap);
    return;
  }
  const flow::Constraint odometric = odometric_constraint(places_.rbegin()->second, submap);
  graph_.add_node(submap.submap_id, graph_.map_from_node(odometric.from) * odometric.from_to.pose);
  // Even a weak constraint would pull if it is wrong by a kilometre.
  if (!begins_island(submap)) graph_.add_constraint(odometric);
}

void LoopCloser::begin_searches(const Place& source) {
  for (RevisitCandidate& candidate : expected_candidates(submaps(), source)) {
    ++counters_.searches;
    searches_.add({config_.revisit, source, {std::move(candidate)}},
                  SearchQueue::Extent::kExpected);
  }
  std::vector<RevisitCandidate> elsewhere = candidates_elsewhere(submaps(), source);
  if (elsewhere.empty()) return;
  counters_.searches += elsewhere.size();
  searches_.add({config_.revisit, source, std::move(elsewhere)}, SearchQueue::Extent::kEverywhere);
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
  if (a.to != b.to || !graph_.are_on_one_island(a.from, b.from)) return false;
  const Eigen::Vector3d apart = geometry::difference(graph_.map_from_node(a.from) * a.from_to.pose,
                                                     graph_.map_from_node(b.from) * b.from_to.pose);
  return apart.head<2>().norm() > kSamePlaceCells * search_cell_m(places_.at(a.to)) ||
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
    const bool is_comparable = graph_.are_on_one_island(other.to, hypothesis.to) &&
                               graph_.are_on_one_island(other.from, hypothesis.from);
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
          const bool is_found_elsewhere = !graph_.are_on_one_island(hypothesis.from, hypothesis.to);
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

bool LoopCloser::close(const Hypothesis& hypothesis) {
  flow::Constraint closure = closure_of(hypothesis);
  const bool joins = !graph_.are_on_one_island(hypothesis.from, hypothesis.to);
  if (!joins && can_defer_solving(closure)) {
    propose(hypothesis);
    if (++unsolved_ >= kMaxUnsolved) solve_deferred();
    return true;
  }
  unsolved_ = 0;
  const ClosureGraph::Snapshot before = graph_.snapshot();
  if (joins) {
    graph_.join_islands(closure);
  } else {
    closure.verdict.squared_error = error_with_graph_uncertainty(closure);
    // The graph may be wrong: with enough agreeing submaps a closure may contradict it.
    if (closure.verdict.squared_error > kMaxSquaredError &&
        support_of(hypothesis) < config_.needed_when_ambiguous) {
      graph_.reject(closure, "contradicts the graph by more than its uncertainty");
      return false;
    }
  }
  const bool is_first_of_group = graph_.founds_group(closure);
  propose(hypothesis);
  if (!joins) graph_.solve_since(before);
  const bool is_active = graph_.is_newest_active();
  if (is_active && is_first_of_group && preceding_submaps_contradict(submaps(), hypothesis.to)) {
    graph_.restore(before);
    closure.verdict.squared_error = graph_.error_of(closure);
    graph_.reject(closure, "preceding submaps would contradict the map");
    return false;
  }
  if (joins) ++counters_.found_elsewhere;
  graph_.update_verdicts("outweighed by closure " + std::to_string(hypothesis.from.value) + " - " +
                         std::to_string(hypothesis.to.value));
  if (is_active) graph_.confirm_path(hypothesis.from, hypothesis.to);
  return is_active;
}

/// Chi-square of a closure against the graph, given the covariances of both.
double LoopCloser::error_with_graph_uncertainty(const flow::Constraint& closure) const {
  flow::Constraint widened = closure;
  widened.from_to.covariance += graph_.expectations_from(closure.from).at(closure.to).covariance;
  return graph_.error_of(widened);
}

/// In a large graph, a closure that the graph predicts within the closure's covariance hardly moves
/// a node: solving is deferred.
bool LoopCloser::can_defer_solving(const flow::Constraint& closure) const {
  constexpr std::size_t kLargeGraph = 100;  // nodes
  constexpr double kPredictedSquaredError = 1.0;
  return graph_.size() > kLargeGraph && graph_.error_of(closure) < kPredictedSquaredError;
}

void LoopCloser::solve_deferred() {
  if (unsolved_ == 0) return;
  unsolved_ = 0;
  graph_.solve("outweighed by later closures");
}

void LoopCloser::propose(const Hypothesis& hypothesis) {
  flow::Constraint closure = closure_of(hypothesis);
  closure.verdict.reason = "supported by " + std::to_string(support_of(hypothesis)) + " submaps";
  graph_.propose(closure, [&](const flow::Constraint& excluded) {
    return agree(
        hypothesis,
        {.from = excluded.from, .to = excluded.to, .from_to = excluded.from_to, .agreement = {}});
  });
}

/// Counts a contradiction where the graph is certain that a submap lies on another and their walls
/// disagree.
void LoopCloser::check_contradiction(const SearchQueue::Finished& search) {
  if (search.searched_sigma_m > config_.sure_within_m ||
      !graph_.are_on_one_island(search.source, search.target) ||
      !contradicts(submaps(), search.target, places_.at(search.source)))
    return;
  ++counters_.contradictions;
  graph_.contradict_path(search.source, search.target);
}

bool LoopCloser::is_connected() const {
  return places_.empty() || graph_.island_of(places_.rbegin()->first) == places_.begin()->first;
}

flow::GraphCorrection LoopCloser::correction() {
  flow::GraphCorrection correction;
  counters_.optimisations = graph_.counters().optimisations;
  counters_.withdrawn = graph_.counters().withdrawn;
  counters_.came_back = graph_.counters().came_back;
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
