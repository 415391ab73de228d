#include "services/tracking/existence_score.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracking/confirmation.hpp"
#include "services/tracking/evidence_limits.hpp"

namespace slammot::tracking {
namespace {

constexpr double kOtherHitScore = 0.1;      ///< Gain of a scan whose echoes need not be moving.
constexpr double kImplausibleScore = -1.0;  ///< Of an extent or speed that no road user has.
constexpr double kEvidenceMemoryS = 0.5;    ///< Of the votes for motion.
constexpr double kMappedMemoryS = 0.8;      ///< Of the share of scans on mapped structure,
constexpr double kMostMappedShare = 0.6;    ///< above which a track without progress
constexpr double kMappedScorePerS = -6.0;   ///< is mapped structure: IDF1 of `city` 0.83 / 0.86,
                                            ///< docs/decisions/existence-and-publication.md.
constexpr double kOccludedScorePerS = -1.0;
constexpr double kHiddenScorePerS = -0.3;  ///< May leave unseen.
constexpr double kOutOfViewScorePerS = -30.0;
constexpr double kPassedBeamScore = -0.6;    ///< Of each beam through the predicted extent,
constexpr double kMostPassedScore = -2.0;    ///< and of all of them in one scan at most.
constexpr double kIndependentAfterS = 0.15;  ///< Neighbouring scans see the same beams pass.

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
  return track.velocity_mps().norm() < moving_above_mps(config) ||
         track.existence.travel.without_progress_s > kLongestStandS;
}

/// Of a miss. Beams pass beside the legs of a pedestrian far away and between them, and those of
/// the next scans do so, too.
double weight_of_miss(const Track& track, int beams, double time_s) {
  constexpr int kFewBeams = 3;
  return may_be_pedestrian(track) && beams <= kFewBeams ? std::min(1.0, time_s / kIndependentAfterS)
                                                        : 1.0;
}

}  // namespace

void score_hit(Track& track, const Hit& hit, const TrackingConfig& config) {
  constexpr double kInconsistentScore = -0.3;  // such a vehicle is re-initialised before it is
                                               // given up
  Existence& existence = track.existence;
  const MotionEvidence& evidence = hit.motion;
  const bool is_moving = hit.label == flow::PointLabel::kMoving ||
                         evidence.moved > evidence.stood + 0.5 * evidence.undecided;
  add_faded(existence.motion, evidence, std::exp(-hit.time_s / kEvidenceMemoryS));
  double gain = is_moving ? evidence_limits(config).moving_hit_score : kOtherHitScore;
  const bool is_mapped = hit.label == flow::PointLabel::kStationary && !is_moving;
  existence.mapped_share += (1.0 - std::exp(-hit.time_s / kMappedMemoryS)) *
                            ((is_mapped ? 1.0 : 0.0) - existence.mapped_share);
  existence.travel.without_progress_s += hit.time_s;
  const double speed_mps = track.velocity_mps().norm();
  if (existence.mapped_share > kMostMappedShare && makes_no_progress(track, config))
    gain = kMappedScorePerS * hit.time_s;
  if (is_contradicted(track, evidence, is_moving) &&
      speed_mps > config.existence.contradicted_above_mps)
    gain = evidence_limits(config).contradiction_score;
  if (!is_plausible(track.extent.outline, config) || speed_mps > 2.0 * config.motion.fastest_mps)
    gain = kImplausibleScore;
  if (is_inconsistent(track, config)) gain = std::min(gain, kInconsistentScore);
  existence.score = std::min(evidence_limits(config).most_score, existence.score + gain);
}

void score_miss(Track& track, const Visibility& visibility, double time_s,
                const TrackingConfig& config) {
  constexpr double kLegUnanswered = 0.1;  // legs are thin and often dark; a vehicle answers
  track.existence.score +=
      (visibility.beams == 0 ? kOutOfViewScorePerS : kOccludedScorePerS) * time_s;
  const double passed =
      visibility.passed +
      (only_people_move(config) && may_be_pedestrian(track) ? kLegUnanswered : 1.0) *
          visibility.unanswered;
  const double share = visibility.beams == 0 ? 0.0 : passed / visibility.beams;  // a partly
                                                                                 // occluded object
                                                                                 // is missed less
                                                                                 // surely
  track.existence.score += weight_of_miss(track, visibility.beams, time_s) *
                           std::max(kMostPassedScore, kPassedBeamScore * passed) * share;
}

void score_unseen(Track& track, double time_s) {
  constexpr double kLeastLikelihood = 0.02;
  track.existence.score +=
      kHiddenScorePerS * time_s +
      time_s / kIndependentAfterS *
          std::log(std::max(kLeastLikelihood, 1.0 - track.history.expected_passed));
}

void score_passed(Track& track, const Visibility& interior, std::size_t echoes) {
  constexpr double kLeastMappedShare = 0.05;
  const int excess = interior.passed - static_cast<int>(echoes);
  if (excess <= 0 || track.existence.mapped_share < kLeastMappedShare) return;
  track.existence.score +=
      std::max(kMostPassedScore, kPassedBeamScore * excess) * interior.passed / interior.beams;
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
