#include "services/loop_closing/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/flow/georeference_verdict.hpp"
#include "services/loop_closing/contradictions.hpp"
#include "services/loop_closing/submap_odometry.hpp"
#include "services/loop_closing/superseded_place.hpp"
#include "services/loop_closing/support.hpp"

namespace slammot::loop_closing {
namespace {

using flow::SubmapId;
using geometry::Pose2;

constexpr int kSupportWaitSubmaps = 6;      // Submaps for which a hypothesis waits for support.
constexpr double kMostUnsolvedCost = 10.0;  // Squared errors of closures that the graph predicted,
                                            // before the next solve.

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
  georeferencing_.add(submap);
  const Place& source =
      places_.emplace(submap.submap_id, make_place(submap, travelled_m_, config_.place))
          .first->second;
  travelled_m_ += submap.travelled_m;
  begin_searches(source);
  for (const SearchQueue::Finished& search : searches_.advance()) take(search);
  close_supported();
  supersede_places_around(source);
  return correction();
}

/// So that memory does not grow where the vehicle drives the same streets again and again. Pending
/// searches refer to places.
void LoopCloser::supersede_places_around(const Place& newest) {
  if (!searches_.is_empty()) return;
  while (const auto superseded = superseded_place(submaps(), newest)) {
    supersede(places_.at(*superseded));
    ++counters_.superseded;
  }
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

flow::GraphCorrection LoopCloser::search_again(SubmapId first) {
  for (auto place = places_.lower_bound(first); place != places_.end(); ++place) {
    begin_expected_searches(place->second);
    for (const SearchQueue::Finished& search : searches_.advance()) take(search);
    close_supported();
  }
  return finish();
}

void LoopCloser::begin_expected_searches(const Place& source) {
  for (RevisitCandidate& candidate : expected_candidates(submaps(), source)) {
    if (graph_.is_on_record(candidate.target.members.front().place->id, source.id)) continue;
    ++counters_.searches;
    searches_.add({config_.revisit, source, {std::move(candidate)}},
                  SearchQueue::Extent::kExpected);
  }
}

void LoopCloser::begin_searches(const Place& source) {
  begin_expected_searches(source);
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
      one.has_rivals = std::any_of(found.begin(), found.end(), [&](const Hypothesis& other) {
        return are_rivals(submaps(), one, other);
      });
    }
  }
  if (search.is_given_up) {
    for (Hypothesis& one : found) one.has_rivals = true;
  }
  if (std::any_of(found.begin(), found.end(), [](const Hypothesis& one) { return one.has_rivals; }))
    ++counters_.ambiguous;
  waiting_.insert(waiting_.end(), found.begin(), found.end());
  // The searches on its own island end one after the other.
  select_on_one_island(submaps(), config_.revisit.rival_ratio, search.source, waiting_);
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
    const double support = support_of(submaps(), waiting_, hypothesis);
    if (support < needed_support_for(hypothesis)) continue;
    const bool has_supported_rival =
        std::any_of(waiting_.begin(), waiting_.end(), [&](const Hypothesis& other) {
          // A hypothesis on another island must be the only one with support.
          const bool is_found_elsewhere = !graph_.are_on_one_island(hypothesis.from, hypothesis.to);
          if (is_found_elsewhere)
            return are_rivals(submaps(), hypothesis, other) &&
                   support_of(submaps(), waiting_, other) >=
                       std::min<double>(support, config_.needed_support);
          const bool is_rival =
              other.to == hypothesis.to && other.from == hypothesis.from && &other != &hypothesis;
          return is_rival && support_of(submaps(), waiting_, other) >= support;
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

/// True if as many submaps as the hypothesis needs agree with it, with each other and, once its
/// islands are joined, with the graph.
bool LoopCloser::holds_after_join(const Hypothesis& hypothesis,
                                  const std::vector<Hypothesis>& supporters) const {
  const auto fits = std::ranges::count_if(supporters, [&](const Hypothesis& one) {
    return one.to == hypothesis.to ||
           error_with_graph_uncertainty(graph_, closure_of(one)) <= kMaxSquaredError;
  });
  return fits >= needed_support_for(hypothesis);
}

bool LoopCloser::close(const Hypothesis& hypothesis) {
  flow::Constraint closure = closure_of(hypothesis);
  const bool joins = !graph_.are_on_one_island(hypothesis.from, hypothesis.to);
  if (!joins && can_defer_solving(closure)) {
    unsolved_cost_ += graph_.error_of(closure);
    propose(hypothesis);
    if (unsolved_cost_ >= kMostUnsolvedCost) solve_deferred();
    return true;
  }
  unsolved_cost_ = 0.0;
  const ClosureGraph::Snapshot before = graph_.snapshot();
  std::vector<Hypothesis> supporters;
  if (joins) {
    supporters = consistent_set(submaps(), waiting_, hypothesis);
    graph_.join_islands(closure);
  } else {
    closure.verdict.squared_error = error_with_graph_uncertainty(graph_, closure);
    // The graph may be wrong: with enough agreeing submaps a closure may contradict it.
    if (closure.verdict.squared_error > kMaxSquaredError &&
        support_of(submaps(), waiting_, hypothesis) < config_.needed_when_ambiguous) {
      graph_.reject(closure, "contradicts the graph by more than its uncertainty");
      return false;
    }
  }
  const bool is_first_of_group = graph_.founds_group(closure);
  propose(hypothesis);
  const auto agrees = [&](const flow::Constraint& excluded) {
    return agree(
        submaps(), hypothesis,
        {.from = excluded.from, .to = excluded.to, .from_to = excluded.from_to, .agreement = {}});
  };
  if (joins) graph_.enable(agrees);
  else graph_.solve_since(before, agrees);
  const bool is_active = graph_.is_newest_active();
  if (joins && !holds_after_join(hypothesis, supporters)) {
    graph_.restore(before);
    graph_.reject(closure, "the submaps that support it contradict each other");
    return false;
  }
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

/// In a large graph, closures that the graph predicts (chi-square, 95 %) hardly move a node:
/// solving is deferred until their squared errors, which bound what a solve can save, add up.
bool LoopCloser::can_defer_solving(const flow::Constraint& closure) const {
  constexpr std::size_t kLargeGraph = 100;  // nodes
  constexpr double kPredictedSquaredError = 7.8;
  return graph_.size() > kLargeGraph && graph_.error_of(closure) < kPredictedSquaredError;
}

void LoopCloser::solve_deferred() {
  if (unsolved_cost_ == 0.0) return;
  unsolved_cost_ = 0.0;
  graph_.solve("outweighed by later closures");
}

void LoopCloser::propose(const Hypothesis& hypothesis) {
  flow::Constraint closure = closure_of(hypothesis);
  closure.verdict.reason =
      "supported by " + std::to_string(std::lround(support_of(submaps(), waiting_, hypothesis))) +
      " submaps";
  graph_.propose(closure);
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
  correction.submaps = graph_.nodes();
  georeference(correction);
  const Place& newest = places_.rbegin()->second;
  correction.map_from_odom =
      correction.submaps.back().map_from_submap * geometry::inverse(newest.odom_from_submap);
  correction.is_untied = !is_connected();
  return correction;
}

/// Corrects the poses of the submaps that are connected to the first one, where GNSS and compass
/// say so.
void LoopCloser::georeference(flow::GraphCorrection& correction) {
  const auto is_connected = [&](SubmapId id) {
    return graph_.island_of(id) == places_.begin()->first;
  };
  std::vector<flow::CorrectedSubmap> connected;
  std::ranges::copy_if(correction.submaps, std::back_inserter(connected), is_connected,
                       &flow::CorrectedSubmap::submap_id);
  const auto found = georeferencing_.compare(connected, [&] {
    std::vector<flow::Constraint> constraints = graph_.active_constraints();
    std::erase_if(constraints,
                  [&](const flow::Constraint& one) { return !is_connected(one.from); });
    return constraints;
  });
  if (!found) return;
  correction.georeference = found->georeference;
  gnss_is_sound_ = !flow::gnss_contradicts_map(found->georeference);
  auto corrected = found->submaps.begin();
  for (flow::CorrectedSubmap& submap : correction.submaps) {
    if (corrected == found->submaps.end()) break;
    if (submap.submap_id == corrected->submap_id) submap = *corrected++;
  }
}

}  // namespace slammot::loop_closing
