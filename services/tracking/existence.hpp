#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace slammot::tracking {

/// Echoes that have moved, have stood, or are undecided, by comparison with earlier scans.
struct MotionEvidence {
  double moved = 0.0;
  double stood = 0.0;
  double undecided = 0.0;

  /// Number of votes; an undecided echo counts half.
  double weight() const { return moved + stood + 0.5 * undecided; }
};

/// Echoes of a tentative track since it was initiated.
struct TentativeEvidence {
  double seen = 0.0;
  double in_free_space = 0.0;  ///< Where the map has seen free space.
  double stood = 0.0;          ///< Where an earlier scan had an echo, too.
};

/// How well recent echoes agree with the extent and the prediction; faded averages.
struct Consistency {
  double off_sides_m = 0.0;  ///< Mean distance of the echoes from the nearest side.
  double nis = 0.0;     ///< Normalised innovation squared of the centre; 2 for a consistent filter.
  double weight = 0.0;  ///< In scans.
};

/// One scan later.
Consistency with_scan(const Consistency& before, double off_sides_m, double nis, double time_s);

/// Beams through the interior of a box, and its echoes, a scan; faded averages. Beams pass a box
/// drawn around several objects.
struct BeamPassage {
  double through = 0.0;
  double met = 0.0;

  double share() const { return through / std::max(1.0, through + met); }
};

/// One scan later: so many beams through the interior and so many echoes.
BeamPassage with_beams(const BeamPassage& before, int through, std::size_t met, double time_s);

/// Distance travelled, in steps larger than noise.
struct Travel {
  double travelled_m = 0.0;                            ///< Since confirmation.
  Eigen::Vector2d anchor_m = Eigen::Vector2d::Zero();  ///< Position at the last step.
  double claimed_m = 0.0;           ///< Integral of the speed since the last step.
  double without_progress_s = 0.0;  ///< Since the last step.
  std::int64_t last_moving_ns = 0;  ///< When it was last faster than a standing object.
};

/// Distance of one step of Travel [m], before scaling.
inline constexpr double kProgressM = 1.0;

/// Time that a confirmed object may stand for each least_travel_to_stand_m of its way:
/// docs/decisions/existence-and-publication.md.
inline constexpr double kLongestStandS = 2.0;

/// Verdict of earlier scans on the velocity.
struct VelocityCheck {
  bool is_refuted = false;
  std::int64_t known_since_ns = 0;  ///< When the velocity became known again after it was too
                                    ///< uncertain to publish; 0: never.
};

/// Whether a track is an object that moves: log-odds (Wang 2004, Eqs. 5.1-5.5) and the evidence
/// they follow from. Invariant: once confirmed, a track stays confirmed.
struct Existence {
  double score = 0.0;  ///< Log-odds; Eq. (5.2).
  bool confirmed = false;
  int hits = 0;           ///< Scans with echoes; 0 marks a track for removal.
  MotionEvidence motion;  ///< Recent, faded.
  TentativeEvidence tentative;
  Travel travel;
  double mapped_share = 0.0;  ///< Share of recent scans in which the echoes lie on mapped
                              ///< structure.
  Consistency consistency;
  BeamPassage passage;  ///< Of a vehicle.
  VelocityCheck velocity_check;
  double mean_echoes = 0.0;  ///< Echoes a scan, faded.
};

/// Probability of existence from log-odds.
double existence_of(double score);

}  // namespace slammot::tracking
