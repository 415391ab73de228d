#include "services/tracking/reidentification.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/tracking/published_covariance.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

/// Density of new objects at any place and velocity [s^2/m^4]: one within 30 m, at up to 10 m/s.
constexpr double kNewObjectDensity = 1.0 / (2800.0 * 314.0);
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

}  // namespace

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
  double best_odds = 0.0;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const Track& lost = tracks[t];
    const bool is_lost = lost.existence.confirmed && lost.existence.hits > 0 &&
                         lost.history.first_published_ns.has_value() &&
                         lost.history.last_seen_ns < found.history.last_seen_ns &&
                         lost.history.last_seen_ns < found.history.first_seen_ns + kMostOverlapNs;
    if (!is_lost || lost.track_id == found.track_id) continue;
    const double odds = log_odds_of_same_object(lost, found, config);
    if (odds <= best_odds) continue;
    best = t;
    best_odds = odds;
  }
  return best;
}

void continue_track(Track& lost, Track& found) {
  found.object_id = lost.object_id;
  found.history.first_seen_ns = lost.history.first_seen_ns;
  found.history.first_published_ns = lost.history.first_published_ns;
  lost.existence.hits = 0;
}

}  // namespace slammot::tracking
