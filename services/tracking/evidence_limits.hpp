#pragma once

#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// What a scan says of existence (log-odds), and how long a tentative track has.
struct EvidenceLimits {
  double moving_hit_score = 0.8;      ///< Gain of a scan with moving echoes.
  double contradiction_score = -0.5;  ///< Of a scan whose echoes lie on what stood before.
  double most_score = 8.0;            ///< Upper limit of the score.
  int least_hits = 5;                 ///< Scans with echoes before confirmation.
  double longest_unseen_tentative_s = 0.4;
  double longest_tentative_s = 1.5;  ///< Twice that where the track seems to move.
};

inline constexpr EvidenceLimits kEvidenceOfVehicles;

/// A scanner near the floor sees legs, thin and often dark: for half a second they do not answer.
/// At a tenth of a second apart errors of scans are nearly independent, so that each scan says
/// more. A pedestrian leaves the place of each foot within the compared time.
inline constexpr EvidenceLimits kEvidenceOfLegs{.moving_hit_score = 1.5,
                                                .contradiction_score = -1.0,
                                                .most_score = 5.0,
                                                .least_hits = 4,
                                                .longest_unseen_tentative_s = 0.7,
                                                .longest_tentative_s = 3.0};

inline const EvidenceLimits& evidence_limits(const TrackingConfig& config) {
  return only_people_move(config) ? kEvidenceOfLegs : kEvidenceOfVehicles;
}

}  // namespace slammot::tracking
