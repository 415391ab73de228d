#include "common/sensing/odometry_episodes.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::sensing {
namespace {

constexpr double kApart_s = 2.0;           // least time between two episodes
constexpr std::uint64_t kApart_scans = 5;  // least number of scans between two episodes, if scans
                                           // are rare
constexpr std::uint64_t kLeastRoughScans = 5;
constexpr std::uint64_t kMostJumpScans = 2;
constexpr double kMoved_m = 0.1;  // smaller motion counts as none
constexpr double kMoved_rad = 0.05;
constexpr double kStillShare = 0.15;  // of the motion by the other source
constexpr double kOffShare = 0.1;

bool is_motion(double way_m, double turn_rad) {
  return std::abs(way_m) > kMoved_m || std::abs(turn_rad) > kMoved_rad;
}

/// True if a is negligible against b.
bool is_still_beside(double a, double b) { return std::abs(a) < kStillShare * std::abs(b); }

/// Turns are also negligible if neither source turns.
bool is_frozen_beside(double way_m, double turn_rad, double other_way_m, double other_turn_rad) {
  const bool goes_nowhere = std::abs(other_way_m) > kMoved_m ? is_still_beside(way_m, other_way_m)
                                                             : std::abs(way_m) <= kMoved_m;
  const bool turns_nowhere = std::abs(other_turn_rad) > kMoved_rad
                                 ? is_still_beside(turn_rad, other_turn_rad)
                                 : std::abs(turn_rad) <= kMoved_rad;
  return is_motion(other_way_m, other_turn_rad) && goes_nowhere && turns_nowhere;
}

bool are_opposite(double a, double b, double least) {
  return a * b < 0.0 && std::min(std::abs(a), std::abs(b)) > least;
}

OdometryFault fault_of(const OdometryEpisode& sums) {
  const double way_m = sums.way_by_wheels_m, turn_rad = sums.turn_by_wheels_rad;
  const double true_way_m = sums.way_by_matches_m, true_turn_rad = sums.turn_by_matches_rad;
  if (is_frozen_beside(way_m, turn_rad, true_way_m, true_turn_rad)) return OdometryFault::kFrozen;
  if (is_frozen_beside(true_way_m, true_turn_rad, way_m, turn_rad))
    return OdometryFault::kMovedAlone;
  if (are_opposite(way_m, true_way_m, kMoved_m)) return OdometryFault::kWrongDirection;
  if (are_opposite(turn_rad, true_turn_rad, kMoved_rad)) return OdometryFault::kWrongTurn;
  const double off_m = std::abs(way_m) - std::abs(true_way_m);
  if (std::abs(off_m) > std::max(kMoved_m, kOffShare * std::abs(true_way_m)))
    return off_m > 0.0 ? OdometryFault::kSlipped : OdometryFault::kShort;
  if (std::abs(turn_rad - true_turn_rad) >
      std::max(kMoved_rad, kOffShare * std::abs(true_turn_rad)))
    return OdometryFault::kMisturned;
  return OdometryFault::kRough;
}

bool are_same(const WheelFactors& a, const WheelFactors& b) {
  return a.way == b.way && a.turn == b.turn && a.turn_bias_radps == b.turn_bias_radps;
}

}  // namespace

void OdometryEpisodes::add(const OdometryStep& step, Motion& motion) {
  if (!step.by_matches || !step.by_wheels) return;
  motion.way_by_wheels_m += step.by_wheels->x_m;
  motion.turn_by_wheels_rad += step.by_wheels->heading_rad;
  motion.way_by_matches_m += step.by_matches->x_m;
  motion.turn_by_matches_rad += step.by_matches->heading_rad;
}

void OdometryEpisodes::add(const Motion& motion, OdometryEpisode& episode) {
  episode.way_by_wheels_m += motion.way_by_wheels_m;
  episode.way_by_matches_m += motion.way_by_matches_m;
  episode.turn_by_wheels_rad += motion.turn_by_wheels_rad;
  episode.turn_by_matches_rad += motion.turn_by_matches_rad;
}

void OdometryEpisodes::observe(const OdometryStep& step, const WheelFactors& factors) {
  if (step.duration_s <= 0.0) return;
  if (last_ && last_->stamp_ns != step.stamp_ns) take(*last_);
  last_ = step;
  if (are_same(factors, factors_)) return;
  factors_ = factors;
  if (conclusions_.recalibrations.size() == kMostRecalibrations)
    conclusions_.recalibrations.pop_back();
  conclusions_.recalibrations.push_back({step.stamp_ns, conclusions_.steps, factors});
}

void OdometryEpisodes::take(const OdometryStep& step) {
  ++conclusions_.steps;
  conclusions_.with_odometry += step.by_wheels.has_value();
  const bool is_missing = !step.by_wheels && had_odometry_;
  had_odometry_ = had_odometry_ || step.by_wheels;
  if (is_missing || (step.by_wheels && !step.is_believed())) {
    conclusions_.disbelieved += step.by_wheels.has_value();
    extend(step);
    return;
  }
  if (!open_) return;
  add(step, open_->since);
  ++open_->scans_since;
  const double since_s = static_cast<double>(step.stamp_ns - open_->episode.end_ns) * 1e-9;
  if (since_s > kApart_s && open_->scans_since > kApart_scans) close();
}

/// Accepted steps between two rejected ones belong to the same episode.
void OdometryEpisodes::extend(const OdometryStep& step) {
  if (!open_) {
    open_ = Open{};
    open_->episode.begin_ns = step.stamp_ns - static_cast<std::int64_t>(step.duration_s * 1e9);
    open_->episode.first_scan = conclusions_.steps - 1;  // the scan before the step
  }
  add(open_->since, open_->episode);
  Motion of_step;
  add(step, of_step);
  add(of_step, open_->episode);
  open_->episode.end_ns = step.stamp_ns;
  open_->episode.scans += open_->scans_since + 1;
  open_->since = {};
  open_->scans_since = 0;
  ++open_->disbelieved;
  open_->missing += !step.by_wheels;
  open_->jumps += step.is_jump;
  open_->is_more_than_rough = open_->is_more_than_rough || !step.by_wheels || step.is_jump ||
                              step.explanation != StepExplanation::kRoughWheels;
}

/// A few rough steps are no episode: noise has tails.
std::optional<OdometryEpisode> OdometryEpisodes::concluded(const Open& open) {
  if (!open.is_more_than_rough && open.disbelieved < kLeastRoughScans) return std::nullopt;
  OdometryEpisode episode = open.episode;
  if (2 * open.missing > open.disbelieved) episode.fault = OdometryFault::kMissing;
  else if (open.jumps > 0 && open.disbelieved <= kMostJumpScans)
    episode.fault = OdometryFault::kJumped;
  else episode.fault = fault_of(episode);
  return episode;
}

void OdometryEpisodes::close() {
  const auto episode = concluded(*open_);
  open_.reset();
  if (!episode) return;
  if (conclusions_.episodes.size() < kMostEpisodes) conclusions_.episodes.push_back(*episode);
  else ++conclusions_.more_episodes;
}

OdometryConclusions OdometryEpisodes::conclusions(const MotionCalibration& calibration,
                                                  double stamp_offset_s) const {
  OdometryEpisodes ended = *this;
  if (ended.last_) ended.take(*ended.last_);
  if (ended.open_) ended.close();
  OdometryConclusions conclusions = std::move(ended.conclusions_);
  conclusions.total = {factors_.way * (1.0 + calibration.x()), factors_.turn,
                       factors_.turn_bias_radps + calibration.y()};
  conclusions.stamp_offset_s = stamp_offset_s;
  return conclusions;
}

}  // namespace slammot::sensing
