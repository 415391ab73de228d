#include "services/tracking/box_measurement.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/tracking_config.hpp"
#include "tests/support/box_echoes.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using testing::echoes_of;
using testing::kStepRad;
using testing::observation_of;

const TrackingConfig kConfig;

/// Measured again and again until the belief has settled.
BoxMeasurement settled(Box box, const Vector2d& predicted_m, const Observation& observation,
                       const TrackingConfig& config = kConfig) {
  box.is_oriented = true;
  BoxMeasurement measurement;
  Vector2d centre_m = predicted_m;
  for (int i = 0; i < 20; ++i) {
    measurement = measure_box(box, centre_m, observation, config);
    box = measurement.box;
    centre_m = measurement.centre_m;
  }
  return measurement;
}

/// Echoes of a box at heading 0 with its corners cut off at 45 degrees, so much of either side.
std::vector<Vector2d> echoes_of_cut(const Vector2d& centre_m, double length_m, double width_m,
                                    double cut_m) {
  std::vector<Vector2d> points;
  const double u_m = 0.5 * length_m, v_m = 0.5 * width_m;
  const std::vector<Vector2d> corners = {
      {u_m - cut_m, v_m},  {u_m, v_m - cut_m},  {u_m, cut_m - v_m},  {u_m - cut_m, -v_m},
      {cut_m - u_m, -v_m}, {-u_m, cut_m - v_m}, {-u_m, v_m - cut_m}, {cut_m - u_m, v_m}};
  for (double angle = -M_PI / 2.0; angle <= M_PI / 2.0; angle += kStepRad) {
    const Vector2d way{std::cos(angle), std::sin(angle)};
    double nearest_m = 1e9;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d from_m = centre_m + corners[i];
      const Vector2d side_m = corners[(i + 1) % corners.size()] - corners[i];
      const double crossed = way.x() * side_m.y() - way.y() * side_m.x();
      if (std::abs(crossed) < 1e-9) continue;
      const double range_m = (from_m.x() * side_m.y() - from_m.y() * side_m.x()) / crossed;
      const double share = (from_m.x() * way.y() - from_m.y() * way.x()) / crossed;
      if (range_m > 0.0 && share >= 0.0 && share <= 1.0) nearest_m = std::min(nearest_m, range_m);
    }
    constexpr double kNoiseM = 0.03;
    if (nearest_m < 1e9) points.push_back((nearest_m + kNoiseM * std::sin(1e4 * angle)) * way);
  }
  return points;
}

/// A car of which only the flank is seen, at heading 0 before a laser at the origin that lies
/// beyond its low end.
Box car_of_unknown_length() {
  Box box;
  box.is_oriented = true;
  return with_likely_sizes(box, kConfig);
}

Observation with_edges(const std::vector<Vector2d>& points, Edge low, Edge high) {
  Observation observation = observation_of(points);
  const bool begins_low = points.front().x() < points.back().x();
  observation.start = begins_low ? low : high;
  observation.end = begins_low ? high : low;
  return observation;
}

TEST(BoxMeasurement, IsAsLongAsACarWhenOnlyTheBackOfOneIsSeen) {
  const auto points = echoes_of({20.0, 0.0}, 4.5, 1.8);
  const Observation observation = observation_of(points);
  const Box box = likely_box(M_PI / 2.0, observation, kConfig);  // the long side that is seen lies
                                                                 // across the view
  EXPECT_EQ(box.kind, Kind::kCar);
  EXPECT_NEAR(std::abs(std::cos(box.heading_rad)), 1.0, 1e-6);
  const BoxMeasurement measurement = settled(box, supposed_centre_m(box, observation), observation);
  EXPECT_NEAR(measurement.centre_m.x(), 20.0, 0.15);
  EXPECT_NEAR(measurement.centre_m.y(), 0.0, 0.1);
  EXPECT_NEAR(measurement.box.width.value_m, 1.8, 0.15);
}

TEST(BoxMeasurement, IsAsLongAsItsFlankWhenThatIsSeenFromEndToEnd) {
  const auto points = echoes_of({8.0, 12.0}, 5.2, 1.9);
  const Observation observation = observation_of(points);
  const BoxMeasurement measurement =
      settled(likely_box(0.0, observation, kConfig), {8.0, 12.0}, observation);
  EXPECT_NEAR(measurement.box.length.value_m, 5.2, 0.15);
  EXPECT_LT((measurement.centre_m - Vector2d(8.0, 12.0)).norm(), 0.2);
}

TEST(BoxMeasurement, IsAsLongAsItIsThoughItsCornersAreRound) {
  const Vector2d centre_m{9.0, 5.0};
  for (const double cut_m : {0.0, 0.35}) {
    const auto points = echoes_of_cut(centre_m, 4.8, 1.8, cut_m);
    const Observation observation = observation_of(points);
    const BoxMeasurement measurement =
        settled(likely_box(0.0, observation, kConfig), centre_m, observation);
    EXPECT_NEAR(measurement.box.corner_seen.value_m, cut_m, 0.08);
    EXPECT_NEAR(measurement.box.length.value_m, 4.8, 0.1)
        << "of a flank seen askew the last " << cut_m << " m lie behind the rest";
    EXPECT_LT((measurement.centre_m - centre_m).norm(), 0.09);
  }
}

TEST(BoxMeasurement, IsAsLargeAsThoseOfItsKindAreHere) {
  const auto points = echoes_of({20.0, 0.0}, 4.8, 1.8);
  const Observation observation = observation_of(points);
  RoadUsersSeen seen;
  for (int i = 0; i < 20; ++i)
    seen.add_length(Kind::kCar, {4.8, 0.004}), seen.add_width(Kind::kCar, {1.8, 0.004});
  const RoadUsers known = seen.known();
  const Box anywhere =
      settled(likely_box(M_PI / 2.0, observation, kConfig), {20.0, 0.0}, observation).box;
  const Box here =
      settled(likely_box(M_PI / 2.0, observation, kConfig, known), {20.0, 0.0}, observation).box;
  EXPECT_NEAR(here.length.value_m, 4.8, 0.05) << "only the back of it is seen";
  EXPECT_LT(here.length.variance_m2, 0.25 * anywhere.length.variance_m2);
  Box longer = here;
  longer.evidence.length = {5.4, {5.6, 0.004}};
  EXPECT_NEAR(with_likely_sizes(longer, kConfig).length.value_m, 5.6, 0.1) << "one from elsewhere";
}

TEST(BoxMeasurement, OfAModelIsMeasuredAsThatOfACarIs) {
  const auto points = echoes_of({8.0, 4.0}, 4.6, 1.9);
  const BoxMeasurement car =
      settled(likely_box(0.0, observation_of(points), kConfig), {8.0, 4.0}, observation_of(points));
  const double scale = 0.1;
  TrackingConfig config;
  config.extent.size_scale = scale;
  for (double* length_m :
       {&config.sensor.range_noise_m, &config.sensor.shape_noise_m, &config.extent.longest_body_m})
    *length_m *= scale;
  std::vector<Vector2d> model_points;
  for (const Vector2d& point : points) model_points.push_back(scale * point);
  const Observation observation = observation_of(model_points);
  const BoxMeasurement model = settled(likely_box(0.0, observation, config),
                                       scale * Vector2d(8.0, 4.0), observation, config);
  EXPECT_NEAR(model.box.length.value_m, scale * car.box.length.value_m, 1e-3);
  EXPECT_NEAR(model.box.width.value_m, scale * car.box.width.value_m, 1e-3);
  EXPECT_LT((model.centre_m - scale * car.centre_m).norm(), 1e-3);
}

TEST(BoxMeasurement, DoesNotShrinkToThePartThatSomethingNearerLeavesInView) {
  auto points = echoes_of({8.0, 12.0}, 5.2, 1.9);
  Box box =
      settled(likely_box(0.0, observation_of(points), kConfig), {8.0, 12.0}, observation_of(points))
          .box;
  points.resize(points.size() / 2);
  Observation half = observation_of(points);
  half.end = Edge::kHidden;
  const BoxMeasurement measurement = settled(box, {8.0, 12.0}, half);
  EXPECT_NEAR(measurement.box.length.value_m, 5.2, 0.2);
}

TEST(BoxMeasurement, IsNotTakenToEndWhereSomethingNearerCutsItsFlankOff) {
  auto points = echoes_of({2.0, 4.0}, 4.5, 1.8);
  std::erase_if(
      points, [](const Vector2d& point) { return point.x() < 1.5 || point.y() > 3.2; });  // the
                                                                                          // rear
                                                                                          // half of
                                                                                          // the
                                                                                          // flank
  Observation observation = observation_of(points);
  observation.start = Edge::kHidden;
  observation.end = Edge::kHidden;
  observation.laser_m = {-2.0, 0.0};  // beyond the low end, where a face would look at it
  (points.front().x() > points.back().x() ? observation.start : observation.end) = Edge::kOpen;
  Box box = likely_box(0.0, observation_of(echoes_of({2.0, 4.0}, 4.5, 1.8)), kConfig);
  box.is_oriented = true;
  const BoxMeasurement measurement = measure_box(box, {2.0, 4.0}, observation, kConfig);
  EXPECT_NEAR(measurement.centre_m.x(), 2.0, 0.3);
}

TEST(BoxMeasurement, EndsWhereAFlankDoesThoughNothingFartherIsEchoedBeyond) {
  const auto points = echoes_of({8.0, 4.0}, 1.7, 0.6);  // a bicycle at the roadside, in the open
  Observation observation = observation_of(points);
  observation.start = observation.end = Edge::kNoEcho;
  Box box;
  const BoxMeasurement measurement =
      settled(with_likely_sizes(box, kConfig), {8.0, 4.0}, observation);  // a car, as far as known
  EXPECT_EQ(measurement.box.kind, Kind::kBicycle);
  EXPECT_NEAR(measurement.box.length.value_m, 1.7, 0.2);
}

TEST(BoxMeasurement, ForgetsThatItWasLargerOnceWhenItIsSeenFromEndToEndAgainAndAgain) {
  const auto points = echoes_of({8.0, 12.0}, 4.5, 1.8);
  Box box;
  box.is_oriented = true;
  box.evidence.length.least_m = 10.0;  // for a moment a wall was taken for a part of it
  box = with_likely_sizes(box, kConfig);
  ASSERT_GT(box.length.value_m, 9.0);
  for (int scan = 0; scan < 150; ++scan)
    box = measure_box(box, {8.0, 12.0}, observation_of(points), kConfig).box;
  EXPECT_NEAR(box.length.value_m, 4.5, 0.3);
}

TEST(BoxMeasurement, DoesNotLearnItsWidthBetterFromManyScansThatAllSeeItFromFarAway) {
  const auto points = echoes_of({57.0, 0.0}, 4.5, 1.8);  // four echoes, half a metre apart
  Box box;
  box.is_oriented = true;
  box = with_likely_sizes(box, kConfig);
  for (int scan = 0; scan < 100; ++scan)
    box = measure_box(box, {57.0, 0.0}, observation_of(points), kConfig).box;
  EXPECT_GT(std::sqrt(box.evidence.width.whole.variance_m2), 0.1);
}

TEST(BoxMeasurement, KeepsTheSideThatIsSeenWhereItIsWhenItGrows) {
  Box box;
  box.is_oriented = true;
  box = with_likely_sizes(box, kConfig);
  const Vector2d centre_m{20.0, 0.0};
  const double back_m = centre_m.x() - 0.5 * box.length.value_m;
  std::vector<Vector2d> points;
  for (double y = -1.25; y <= 1.25; y += 0.1) points.emplace_back(back_m, y);  // wider than a car
  const BoxMeasurement measurement = measure_box(box, centre_m, observation_of(points), kConfig);
  ASSERT_GT(measurement.box.length.value_m, box.length.value_m + 1.0);
  EXPECT_NEAR((centre_m + measurement.recentring_m).x() - 0.5 * measurement.box.length.value_m,
              back_m, 1e-6);
}

TEST(BoxMeasurement, SaysThatItsCentreMakesAStepWhenAnotherEndOfItIsSeen) {
  std::vector<Vector2d> flank;
  for (double x = 8.0; x < 9.6; x += 0.1) flank.emplace_back(x, 3.0);
  const Vector2d centre_m{9.0, 3.9};
  Box box = car_of_unknown_length();
  const Observation far_end = with_edges(flank, Edge::kHidden, Edge::kOpen);
  const BoxMeasurement first = measure_box(box, centre_m, far_end, kConfig);
  EXPECT_EQ(first.box.anchors.length, 1);
  EXPECT_TRUE(first.step_covariance_m2.isZero());
  EXPECT_TRUE(measure_box(first.box, centre_m, far_end, kConfig).step_covariance_m2.isZero());
  const BoxMeasurement second =
      measure_box(first.box, centre_m, with_edges(flank, Edge::kOpen, Edge::kHidden), kConfig);
  EXPECT_EQ(second.box.anchors.length, -1);
  EXPECT_NEAR(second.step_covariance_m2(0, 0), second.box.length.variance_m2, 1e-9);
  EXPECT_GT(second.box.length.variance_m2, 0.1);
}

TEST(BoxMeasurement, OfWhichFewBeamsAreAnsweredDoesNotEndAtALoneEcho) {
  const std::vector<Vector2d> echo = {{9.0, 3.0}};
  Observation observation = with_edges(echo, Edge::kNoEcho, Edge::kNoEcho);
  const Vector2d centre_m{9.0, 3.9};
  const auto sigma_along_m = [&](double unanswered_share) {
    observation.unanswered_share = unanswered_share;
    return std::sqrt(
        measure_box(car_of_unknown_length(), centre_m, observation, kConfig).covariance_m2(0, 0));
  };
  EXPECT_LT(sigma_along_m(0.05), 0.3);
  EXPECT_GT(sigma_along_m(0.75), 1.0);
}

}  // namespace
}  // namespace slammot::tracking
