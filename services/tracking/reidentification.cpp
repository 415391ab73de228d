#include "services/tracking/reidentification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/filters/kalman.hpp"
#include "services/tracking/confirmation.hpp"
#include "services/tracking/evidence_limits.hpp"
#include "services/tracking/published_covariance.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

/// Density of new objects at any place and velocity [s^2/m^4]: one within 30 m, at up to 10 m/s.
constexpr double kNewObjectDensity = 1.0 / (2800.0 * 314.0);
/// Tentative tracks that may_have_returned() and are never confirmed, for one that is: counted,
/// docs/decisions/existence-and-publication.md.
constexpr double kStationaryOverNew = 4.0;
constexpr double kGate = 13.28;  ///< Chi-square, four degrees of freedom, 99 %.

/// State covariance with the errors that the filter does not know.
Matrix4d covariance_of(const Track& track, const TrackingConfig& config) {
  Matrix4d P = track.kinematics.estimate.covariance.topLeftCorner<4, 4>();
  P.topLeftCorner<2, 2>() += common_error_covariance(track, track.footprint().heading_rad, config);
  return P;
}

/// Likelihood ratio of the classes: the same one against any.
double ratio_of_classes(const Classification& a, const Classification& b) {
  double same = 0.0;
  for (std::size_t i = 0; i < a.probability.size(); ++i)
    same += a.probability[i] * b.probability[i];
  return same * static_cast<double>(a.probability.size());
}

/// The found track's state, conditioned on the prediction of the lost one.
filters::MotionState fused(const Track& found, const Track& lost, const TrackingConfig& config) {
  Matrix4d R = covariance_of(lost, config);
  R.topLeftCorner<2, 2>() += common_error_covariance(found, found.footprint().heading_rad, config);
  return filters::kalman_update<6, 4>(found.kinematics.estimate,
                                      lost.kinematics.estimate.mean.head<4>(),
                                      Eigen::Matrix<double, 4, 6>::Identity(), R)
      .posterior;
}

/// True for a hidden track of something that surely moved, where the tentative one is more certain
/// of the place than its prediction. What is not hidden takes echoes itself.
bool may_be_replaced(const Track& lost, const Track& tentative, const TrackingConfig& config) {
  const auto variance_m2 = [&](const Track& track) {
    return covariance_of(track, config).topLeftCorner<2, 2>().trace();
  };
  return lost.history.is_hidden && lost.existence.travel.travelled_m > 0.0 &&
         variance_m2(tentative) < variance_m2(lost);
}

/// What the log-odds must exceed. Those of a tentative track replace the prior of its existence,
/// and it is waited for until it is surely the same object: a wrong one ends the right track.
double least_odds(const Track& found) {
  constexpr double kSure = 0.95;
  return found.existence.confirmed ? 0.0
                                   : std::log(kStationaryOverNew * kSure / (1.0 - kSure)) +
                                         std::max(0.0, kConfirmScore - found.existence.score);
}

}  // namespace

bool may_have_returned(const Track& track, const TrackingConfig& config) {
  constexpr double kMostNis = 2.0;  // the mean of a consistent filter
  const Existence& existence = track.existence;
  const MotionEvidence& motion = existence.motion;
  if (motion.stood > motion.moved + motion.undecided) return false;
  return track.history.misses == 0 && existence.hits >= evidence_limits(config).least_hits &&
         is_surely_fast(track) && existence.consistency.nis < kMostNis &&
         !echoes_lie_off_sides(track, config) && !existence.velocity_check.is_refuted;
}

double log_odds_of_same_object(const Track& lost, const Track& found,
                               const TrackingConfig& config) {
  constexpr double kNever = -std::numeric_limits<double>::infinity();
  const Matrix4d S = covariance_of(lost, config) + covariance_of(found, config);
  const Vector4d residual =
      (found.kinematics.estimate.mean - lost.kinematics.estimate.mean).head<4>();
  const Eigen::LLT<Matrix4d> factor(S);
  if (factor.info() != Eigen::Success) return kNever;
  const double distance2 = residual.dot(factor.solve(residual));
  const double classes = ratio_of_classes(lost.classification, found.classification);
  if (distance2 > kGate || classes <= 0.0) return kNever;
  const double log_volume =
      0.5 * std::log(S.determinant()) + 2.0 * std::log(2.0 * std::numbers::pi);
  return -0.5 * distance2 - log_volume - std::log(kNewObjectDensity) + std::log(classes);
}

std::optional<std::size_t> track_of_same_object(const Track& found, std::span<const Track> tracks,
                                                const TrackingConfig& config) {
  constexpr std::int64_t kMostOverlapNs = 200'000'000;  // the lost track had other echoes at its
                                                        // end
  std::optional<std::size_t> best;
  double best_odds = least_odds(found);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const Track& lost = tracks[t];
    const bool is_lost = lost.existence.confirmed && lost.existence.hits > 0 &&
                         lost.history.first_published_ns.has_value() &&
                         lost.history.last_seen_ns < found.history.last_seen_ns &&
                         lost.history.last_seen_ns < found.history.first_seen_ns + kMostOverlapNs;
    if (!is_lost || lost.track_id == found.track_id) continue;
    if (!found.existence.confirmed && !may_be_replaced(lost, found, config)) continue;
    const double odds = log_odds_of_same_object(lost, found, config);
    if (odds <= best_odds) continue;
    best = t;
    best_odds = odds;
  }
  return best;
}

void continue_track(Track& lost, Track& found, const TrackingConfig& config) {
  restart_from(found.kinematics, fused(found, lost, config), config);
  found.object_id = lost.object_id;
  found.history.first_seen_ns = lost.history.first_seen_ns;
  found.history.first_published_ns = lost.history.first_published_ns;
  lost.existence.hits = 0;
}

}  // namespace slammot::tracking
