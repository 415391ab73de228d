#include "services/loop_closing/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
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
constexpr double kSamePlaceCells = 5.0;              // of the search: nearer to each other it does not tell places apart,
constexpr double kSamePlace_rad = 0.15;              // nor with less between their headings
constexpr double kClearlyWorse = 2.0;                // times the contradictions of the best,
constexpr double kNoise_share = 0.01;                // and this much more
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

bool is_finite(const Pose2& pose) { return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.heading_rad); }

/// Whether all that the graph is made from are numbers.
bool is_sound(const flow::Submap& submap) {
  return is_finite(submap.odom_from_submap) && is_finite(submap.previous_from_submap.pose) && submap.previous_from_submap.covariance.allFinite() &&
         is_finite(submap.submap_from_base_at_end) && std::isfinite(submap.travelled_m) &&
         std::all_of(submap.surfels.begin(), submap.surfels.end(), [](const flow::Surfel& surfel) {
           return std::isfinite(surfel.x_m) && std::isfinite(surfel.y_m) && std::isfinite(surfel.normal_x) && std::isfinite(surfel.normal_y);
         });
}

double quality_of(const Hypothesis& hypothesis) { return hypothesis.quality(); }
double contradicted_share_of(const Hypothesis& hypothesis) { return 1.0 - hypothesis.agreement.agreed_share(); }

/// In corridors all of which look alike most of the walls agree anywhere: what contradicts tells them apart.
void drop_clearly_worse(std::vector<Hypothesis>& hypotheses, double rival_ratio) {
  const double best_quality = std::ranges::max(hypotheses, {}, quality_of).quality();
  std::erase_if(hypotheses, [&](const Hypothesis& one) { return one.quality() < rival_ratio * best_quality; });
  const double least_contradicted = contradicted_share_of(std::ranges::min(hypotheses, {}, contradicted_share_of));
  std::erase_if(hypotheses, [&](const Hypothesis& one) { return contradicted_share_of(one) > kClearlyWorse * least_contradicted + kNoise_share; });
}

/// The middles of both on each other, and no more known than that.
UncertainPose2 anywhere_on(const Place& target, const Place& source, double sigma_m) {
  const Vector2 shift_m = target.middle_m - source.middle_m;
  return {{shift_m.x(), shift_m.y(), 0.0}, Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, std::numbers::pi * std::numbers::pi).asDiagonal()};
}

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
  if (!is_sound(submap)) {
    ++counters_.faulty_submaps;
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
  // However weak, a tie that is wrong by a kilometre would pull.
  if (has_gone_astray(submap)) return;
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

/// The nearest by the last that is known of the vehicle: nobody knows better where to begin.
std::vector<LoopCloser::Candidate> LoopCloser::candidates_elsewhere_for(const Place& source) const {
  const Islands on = islands_now();
  const Vector2 source_in_map_m = graph_.map_from_node(source.id) * source.middle_m;
  std::vector<Candidate> all;
  for (const auto& [id, target] : places_) {
    if (on.at(id) == on.at(source.id)) continue;
    all.push_back({id, anywhere_on(target, source, config_.max_distance_m), (graph_.map_from_node(id) * target.middle_m - source_in_map_m).norm()});
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.distance_m < b.distance_m; });
  all.resize(std::min(all.size(), static_cast<std::size_t>(config_.max_candidates_elsewhere)));
  return all;
}

Target LoopCloser::target_around(SubmapId id, const Place& source) const {
  const Islands on = islands_now();
  Target target{{{&places_.at(id), Pose2::identity()}}};
  const Pose2 target_from_map = geometry::inverse(graph_.map_from_node(id));
  for (int step = -config_.neighbours; step <= config_.neighbours; ++step) {
    const auto found = places_.find({static_cast<std::uint32_t>(static_cast<std::int64_t>(id.value) + step)});
    if (step == 0 || found == places_.end() || on.at(found->first) != on.at(id)) continue;
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
  look_elsewhere(source);
}

/// Two places far from each other may look alike: those found in all of them are each other's rivals.
void LoopCloser::look_elsewhere(const Place& source) {
  std::vector<Hypothesis> found;
  for (const Candidate& candidate : candidates_elsewhere_for(source)) {
    ++counters_.searches;
    const auto there = finder_.find(target_around(candidate.id, source), source, candidate.target_from_source);
    found.insert(found.end(), there.begin(), there.end());
  }
  if (found.empty()) return;
  ++counters_.hypotheses;
  drop_clearly_worse(found, config_.revisit.rival_ratio);
  const Islands on = islands_now();
  for (Hypothesis& one : found) {
    one.has_rivals = std::any_of(found.begin(), found.end(), [&](const Hypothesis& other) { return are_rivals(one, other, on); });
  }
  if (std::any_of(found.begin(), found.end(), [](const Hypothesis& one) { return one.has_rivals; })) ++counters_.ambiguous;
  waiting_.insert(waiting_.end(), found.begin(), found.end());
}

/// Whether both put one submap onto one island, in different places.
bool LoopCloser::are_rivals(const Hypothesis& a, const Hypothesis& b, const Islands& on) const {
  if (a.to != b.to || on.at(a.from) != on.at(b.from)) return false;
  const Eigen::Vector3d apart = geometry::difference(graph_.map_from_node(a.from) * a.from_to.pose, graph_.map_from_node(b.from) * b.from_to.pose);
  return apart.head<2>().norm() > kSamePlaceCells * config_.revisit.search_cell_m || std::abs(apart.z()) > kSamePlace_rad;
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
  const Islands on = islands_now();
  std::set<SubmapId> supporters{hypothesis.to};
  for (const Hypothesis& other : waiting_) {
    const bool is_comparable = on.at(other.to) == on.at(hypothesis.to) && on.at(other.from) == on.at(hypothesis.from);
    if (other.to != hypothesis.to && is_comparable && agree(hypothesis, other)) supporters.insert(other.to);
  }
  return static_cast<int>(supporters.size());
}

int LoopCloser::needed_support_for(const Hypothesis& hypothesis) const {
  if (hypothesis.has_rivals) return config_.needed_when_ambiguous;
  return hypothesis.searched_sigma_m <= config_.sure_within_m ? 1 : config_.needed_support;
}

void LoopCloser::close_what_is_firm() {
  const Islands on = islands_now();
  std::vector<Hypothesis> firm;
  for (const Hypothesis& hypothesis : waiting_) {
    if (hypothesis.agreement.agreed_share() < config_.revisit.min_agreed_share) continue;  // good for the support of others
    const int support = support_of(hypothesis);
    if (support < needed_support_for(hypothesis)) continue;
    const bool has_equal_rival = std::any_of(waiting_.begin(), waiting_.end(), [&](const Hypothesis& other) {
      // Found anywhere at all, it must be the only one that others support.
      const bool is_found_elsewhere = on.at(hypothesis.from) != on.at(hypothesis.to);
      if (is_found_elsewhere) return are_rivals(hypothesis, other, on) && support_of(other) >= std::min(support, config_.needed_support);
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

/// The later island moves, all of it: the map is where the first submap is.
void LoopCloser::join_islands(const Hypothesis& hypothesis, const Islands& on) {
  const bool to_moves = on.at(hypothesis.from) < on.at(hypothesis.to);
  const Pose2 map_from_from = graph_.map_from_node(hypothesis.from);
  const Pose2 map_from_to = graph_.map_from_node(hypothesis.to);
  const Pose2 shift = to_moves ? map_from_from * hypothesis.from_to.pose * geometry::inverse(map_from_to)
                               : map_from_to * geometry::inverse(hypothesis.from_to.pose) * geometry::inverse(map_from_from);
  const SubmapId moving = on.at(to_moves ? hypothesis.to : hypothesis.from);
  for (const auto& [id, island] : on) {
    if (island == moving) graph_.move_node(id, shift * graph_.map_from_node(id));
  }
  ++counters_.found_elsewhere;
}

bool LoopCloser::close(const Hypothesis& hypothesis) {
  const Constraint constraint = loop_constraint(hypothesis);
  const Islands on = islands_now();
  if (on.at(hypothesis.from) != on.at(hypothesis.to)) {
    join_islands(hypothesis, on);
    graph_.add_constraint(constraint);
    return true;
  }
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

bool LoopCloser::knows_where_it_is() const { return places_.empty() || islands_now().at(places_.rbegin()->first) == places_.begin()->first; }

flow::GraphCorrection LoopCloser::correction() {
  flow::GraphCorrection correction;
  correction.sequence = ++sequence_;
  if (places_.empty()) return correction;
  const Place& newest = places_.rbegin()->second;
  correction.map_from_odom = graph_.map_from_node(newest.id) * geometry::inverse(newest.odom_from_submap);
  correction.submaps = graph_.nodes();
  correction.is_untied = !knows_where_it_is();
  return correction;
}

}  // namespace slammot::loop_closing
