#include "services/tracking/blob.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

const TrackingConfig kConfig;
constexpr double kStepRad = 0.5 * M_PI / 180.0;

Observation observation_of(const std::vector<Vector2d>& points) {
  Observation observation;
  observation.points_m = points;
  observation.beam_step_rad = kStepRad;
  return observation;
}

Observation with_edges(const std::vector<Vector2d>& points, Edge low, Edge high) {
  Observation observation = observation_of(points);
  const bool begins_low = points.front().x() < points.back().x();
  observation.start = begins_low ? low : high;
  observation.end = begins_low ? high : low;
  return observation;
}

/// Echoes of a round box as a laser at the origin gets them.
std::vector<Vector2d> echoes_of_disc(const Vector2d& centre_m, double radius_m) {
  std::vector<Vector2d> points;
  for (double angle = -M_PI / 2.0; angle <= M_PI / 2.0; angle += 0.1 * kStepRad) {
    const Vector2d way{std::cos(angle), std::sin(angle)};
    const double along_m = way.dot(centre_m);
    const double half2 = radius_m * radius_m - (centre_m - along_m * way).squaredNorm();
    if (half2 > 0.0) points.push_back((along_m - std::sqrt(half2)) * way);
  }
  return points;
}

TEST(Blob, WithoutSidesIsSomewhereAboutAnEchoThatIsRarelyAnswered) {
  const std::vector<Vector2d> echo = {{25.0, 0.0}};
  Observation observation = observation_of(echo);
  const auto sigma_m = [&](double unanswered_share) {
    observation.unanswered_share = unanswered_share;
    return std::sqrt(measure_blob({}, observation, kConfig).covariance_m2(1, 1));
  };
  EXPECT_LT(sigma_m(0.05), 0.1);
  EXPECT_GT(sigma_m(0.75), 0.35);
}

TEST(Blob, IsSomewhereWithinAFifthOfItsSpan) {
  std::vector<Vector2d> echoes;
  for (double y = -0.5; y < 0.51; y += 0.02) echoes.emplace_back(10.0, y);
  const Eigen::Matrix2d covariance_m2 =
      measure_blob({}, observation_of(echoes), kConfig).covariance_m2;
  EXPECT_NEAR(std::sqrt(covariance_m2(1, 1)), std::hypot(0.2, kConfig.sensor.shape_noise_m), 0.01);
}

TEST(Blob, WithoutSidesWasSeenWholeOnceNothingHasHiddenAnEndOfIt) {
  const std::vector<Vector2d> echoes = {{25.0, -0.2}, {25.0, 0.0}, {25.0, 0.2}};
  const Blob hidden =
      measure_blob({}, with_edges(echoes, Edge::kHidden, Edge::kOpen), kConfig).blob;
  const Blob vague =
      measure_blob(hidden, with_edges(echoes, Edge::kNoEcho, Edge::kOpen), kConfig).blob;
  EXPECT_FALSE(vague.was_seen_whole);
  const Blob whole =
      measure_blob(vague, with_edges(echoes, Edge::kOpen, Edge::kOpen), kConfig).blob;
  EXPECT_TRUE(measure_blob(whole, with_edges(echoes, Edge::kHidden, Edge::kOpen), kConfig)
                  .blob.was_seen_whole);
}

TEST(Blob, OfLegsOrACoatHasItsMiddleWithinAFewCentimetres) {
  const Vector2d centre_m{6.0, 1.0};
  for (const double radius_m : {0.07, 0.125}) {
    const auto echoes = echoes_of_disc(centre_m, radius_m);
    EXPECT_LT((measure_blob({}, observation_of(echoes), kConfig).centre_m - centre_m).norm(), 0.03)
        << radius_m;
  }
}

TEST(Blob, OfSomethingSmallIsAsDeepAsTheScaleSays) {
  TrackingConfig config;
  config.extent.size_scale = 0.1;
  const Vector2d centre_m{2.0, 0.3};
  const auto echoes = echoes_of_disc(centre_m, 0.01);
  EXPECT_LT((measure_blob({}, observation_of(echoes), config).centre_m - centre_m).norm(), 0.003);
}

}  // namespace
}  // namespace slammot::tracking
