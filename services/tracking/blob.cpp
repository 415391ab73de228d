#include "services/tracking/blob.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

/// What dark gaps add to the noise: of a poorly answering object other parts are seen in each scan.
double gap_noise_m(const Observation& observation, double range_m, double size_scale) {
  constexpr double kBetweenLegsM = 0.25;
  constexpr double kMostM = 1.3;
  return std::clamp(
      mean_gap(observation) * range_m * observation.beam_step_rad - kBetweenLegsM * size_scale, 0.0,
      kMostM * size_scale);
}

}  // namespace

BlobMeasurement measure_blob(const Blob& blob, const Observation& observation,
                             const TrackingConfig& config) {
  constexpr double kSurfaceToMiddleM = 0.08;  // pi/4 of half the depth: 0.1 for a coat, 0.06 for
                                              // legs
  BlobMeasurement measurement;
  Vector2d mean_m = Vector2d::Zero();
  for (const Vector2d& point : observation.points_m) mean_m += point;
  mean_m /= static_cast<double>(observation.points_m.size());
  const Vector2d sight_m = mean_m - observation.laser_m;
  const double range_m = std::max(sight_m.norm(), 1e-3);
  const Vector2d along = sight_m / range_m;
  const Vector2d across{-along.y(), along.x()};
  const double span_m = largest_span_m(observation.points_m);
  const double shape_m = std::hypot(kBlobNoiseShare * span_m, config.sensor.shape_noise_m,
                                    gap_noise_m(observation, range_m, config.extent.size_scale));
  const double sigma_along_m = std::hypot(echo_sigma_m(range_m, config), shape_m);
  const double sigma_across_m = std::hypot(range_m * observation.beam_step_rad / 3.5, shape_m);
  measurement.centre_m = mean_m + kSurfaceToMiddleM * config.extent.size_scale * along;
  measurement.covariance_m2 = sigma_along_m * sigma_along_m * along * along.transpose() +
                              sigma_across_m * sigma_across_m * across * across.transpose();
  Blob& after = measurement.blob;
  after = blob;
  const double grown_m = std::max(span_m, blob.length.value_m);
  after.length.value_m = blob.length.value_m + 0.2 * (grown_m - blob.length.value_m);
  after.width.value_m = after.length.value_m;
  after.was_seen_whole =
      blob.was_seen_whole || (observation.start == Edge::kOpen && observation.end == Edge::kOpen);
  return measurement;
}

}  // namespace slammot::tracking
