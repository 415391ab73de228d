#include "services/tracking/existence_score.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracking/confirmation.hpp"

namespace slammot::tracking {
namespace {

void add_faded(MotionEvidence& sum, const MotionEvidence& evidence, double fade) {
  sum.moved = fade * sum.moved + evidence.moved;
  sum.stood = fade * sum.stood + evidence.stood;
  sum.undecided = fade * sum.undecided + evidence.undecided;
}

/// True if most echoes come from where something stood. Also for a confirmed pedestrian without
/// moved echoes: a pedestrian comes to where nothing was; what always was there only seems to walk,
/// from object to object.
bool is_contradicted(const Track& track, const MotionEvidence& evidence, bool is_moving) {
  const double stands_share =
      evidence.stood / std::max(1.0, evidence.stood + evidence.moved + evidence.undecided);
  const bool seems_to_walk =
      track.existence.confirmed && may_be_pedestrian(track) && !is_moving && evidence.moved == 0.0;
  return stands_share > 0.5 || seems_to_walk;
}

bool makes_no_progress(const Track& track, const TrackingConfig& config) {
  return track.velocity_mps().norm() < config.moving_above_mps ||
         track.existence.travel.without_progress_s > config.longest_stand_s;
}

}  // namespace

void score_hit(Track& track, const Hit& hit, const TrackingConfig& config) {
  constexpr double kInconsistentScore = -0.3;  // such a vehicle is re-initialised before it is
                                               // given up
  Existence& existence = track.existence;
  const MotionEvidence& evidence = hit.motion;
  const bool is_moving = hit.label == flow::PointLabel::kMoving ||
                         evidence.moved > evidence.stood + 0.5 * evidence.undecided;
  add_faded(existence.motion, evidence, std::exp(-hit.time_s / config.evidence_memory_s));
  double gain = is_moving ? config.moving_hit_score : config.other_hit_score;
  const bool is_mapped = hit.label == flow::PointLabel::kStationary && !is_moving;
  existence.mapped_share += (1.0 - std::exp(-hit.time_s / config.mapped_memory_s)) *
                            ((is_mapped ? 1.0 : 0.0) - existence.mapped_share);
  existence.travel.without_progress_s += hit.time_s;
  const double speed_mps = track.velocity_mps().norm();
  if (existence.mapped_share > config.most_mapped_share && makes_no_progress(track, config))
    gain = config.mapped_score_per_s * hit.time_s;
  if (is_contradicted(track, evidence, is_moving) && speed_mps > config.contradicted_above_mps)
    gain = config.contradiction_score;
  if (!is_plausible(track.extent.outline, config) || speed_mps > 2.0 * config.fastest_mps)
    gain = config.implausible_score;
  if (is_inconsistent(track, config)) gain = std::min(gain, kInconsistentScore);
  existence.score = std::min(config.most_score, existence.score + gain);
}

void score_miss(Track& track, const Visibility& visibility, double time_s,
                const TrackingConfig& config) {
  constexpr double kLegUnanswered = 0.1;  // legs are thin and often dark; a vehicle answers
  track.existence.score +=
      (visibility.beams == 0 ? config.out_of_view_score_per_s : config.occluded_score_per_s) *
      time_s;
  const double passed =
      visibility.passed +
      (only_people_move(config) && may_be_pedestrian(track) ? kLegUnanswered : 1.0) *
          visibility.unanswered;
  const double share = visibility.beams == 0 ? 0.0 : passed / visibility.beams;  // a partly
                                                                                 // occluded object
                                                                                 // is missed less
                                                                                 // surely
  track.existence.score +=
      std::max(config.most_passed_score, config.passed_beam_score * passed) * share;
}

void score_passed(Track& track, const Visibility& interior, std::size_t echoes,
                  const TrackingConfig& config) {
  constexpr double kLeastMappedShare = 0.05;
  const int excess = interior.passed - static_cast<int>(echoes);
  if (excess <= 0 || track.existence.mapped_share < kLeastMappedShare) return;
  track.existence.score += std::max(config.most_passed_score, config.passed_beam_score * excess) *
                           interior.passed / interior.beams;
}

Footprint interior_of(const Track& track) {
  constexpr double kLeastM = 0.3;
  const double sigma_m = std::sqrt(0.5 * track.kinematics.position_covariance_m2().trace());
  Footprint interior = track.footprint();
  for (Size* size : {&interior.length, &interior.width})
    size->value_m = std::max(kLeastM, size->value_m - std::sqrt(size->variance_m2) - 2.0 * sigma_m);
  return interior;
}

}  // namespace slammot::tracking
