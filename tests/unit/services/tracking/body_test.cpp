#include "services/tracking/body.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

const TrackingConfig kConfig;
constexpr double kStepRad = 0.5 * M_PI / 180.0;

/// Echoes of a box at heading 0 as a laser at the origin gets them.
std::vector<Vector2d> echoes_of(const Vector2d& centre_m, double length_m, double width_m) {
  std::vector<Vector2d> points;
  for (double angle = -M_PI / 2.0; angle <= M_PI / 2.0; angle += kStepRad) {
    const Vector2d way{std::cos(angle), std::sin(angle)};
    double near = 0.0, far = 1e9;
    const double half[2] = {0.5 * length_m, 0.5 * width_m};
    for (int axis = 0; axis < 2; ++axis) {
      const double a = (centre_m[axis] - half[axis]) / way[axis], b = (centre_m[axis] + half[axis]) / way[axis];
      near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    if (near < far) points.push_back(near * way);
  }
  return points;
}

Observation observation_of(const std::vector<Vector2d>& points) {
  Observation observation;
  observation.points_m = points;
  observation.beam_step_rad = kStepRad;
  return observation;
}

/// Measured again and again until the belief has settled.
BodyMeasurement settled(Body body, const Vector2d& predicted_m, const Observation& observation, const TrackingConfig& config = kConfig) {
  body.is_oriented = true;
  BodyMeasurement measurement;
  Vector2d centre_m = predicted_m;
  for (int i = 0; i < 20; ++i) {
    measurement = measure_box(body, centre_m, observation, config);
    body = measurement.body;
    centre_m = measurement.centre_m;
  }
  return measurement;
}

TEST(Body, IsAsLongAsACarWhenOnlyTheBackOfOneIsSeen) {
  const auto points = echoes_of({20.0, 0.0}, 4.5, 1.8);
  const Observation observation = observation_of(points);
  const Body body = likely_box(M_PI / 2.0, observation, kConfig);  // the long side that is seen lies across the view
  EXPECT_EQ(body.kind, Kind::kCar);
  EXPECT_NEAR(std::abs(std::cos(body.heading_rad)), 1.0, 1e-6);
  const BodyMeasurement measurement = settled(body, supposed_centre_m(body, observation), observation);
  EXPECT_NEAR(measurement.centre_m.x(), 20.0, 0.15);
  EXPECT_NEAR(measurement.centre_m.y(), 0.0, 0.1);
  EXPECT_NEAR(measurement.body.width.value_m, 1.8, 0.15);
}

TEST(Body, IsLongerThanACarBehindABackThatIsWiderThanACars) {
  const auto points = echoes_of({20.0, 0.0}, 12.0, 2.5);
  const Body body = likely_box(M_PI / 2.0, observation_of(points), kConfig);
  EXPECT_TRUE(body.kind == Kind::kTruck || body.kind == Kind::kBus);
  EXPECT_GT(body.length.variance_m2, 1.0);  // which of the two is open
}

TEST(Body, IsAsLongAsItsFlankWhenThatIsSeenFromEndToEnd) {
  const auto points = echoes_of({8.0, 12.0}, 5.2, 1.9);
  const Observation observation = observation_of(points);
  const BodyMeasurement measurement = settled(likely_box(0.0, observation, kConfig), {8.0, 12.0}, observation);
  EXPECT_NEAR(measurement.body.length.value_m, 5.2, 0.15);
  EXPECT_LT((measurement.centre_m - Vector2d(8.0, 12.0)).norm(), 0.2);
}

/// Echoes of a box at heading 0 with its corners cut off at 45 degrees, so much of either side.
std::vector<Vector2d> echoes_of_cut(const Vector2d& centre_m, double length_m, double width_m, double cut_m) {
  std::vector<Vector2d> points;
  const double u_m = 0.5 * length_m, v_m = 0.5 * width_m;
  const std::vector<Vector2d> corners = {{u_m - cut_m, v_m}, {u_m, v_m - cut_m}, {u_m, cut_m - v_m}, {u_m - cut_m, -v_m},
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

TEST(Body, IsAsLongAsItIsThoughItsCornersAreRound) {
  const Vector2d centre_m{9.0, 5.0};
  for (const double cut_m : {0.0, 0.35}) {
    const auto points = echoes_of_cut(centre_m, 4.8, 1.8, cut_m);
    const Observation observation = observation_of(points);
    const BodyMeasurement measurement = settled(likely_box(0.0, observation, kConfig), centre_m, observation);
    EXPECT_NEAR(measurement.body.corner_seen.value_m, cut_m, 0.08);
    EXPECT_NEAR(measurement.body.length.value_m, 4.8, 0.1) << "of a flank seen askew the last " << cut_m << " m lie behind the rest";
    EXPECT_LT((measurement.centre_m - centre_m).norm(), 0.09);
  }
}

TEST(Body, IsAsLargeAsThoseOfItsKindAreHere) {
  const auto points = echoes_of({20.0, 0.0}, 4.8, 1.8);
  const Observation observation = observation_of(points);
  RoadUsersSeen seen;
  for (int i = 0; i < 20; ++i) seen.add_length(Kind::kCar, {4.8, 0.004}), seen.add_width(Kind::kCar, {1.8, 0.004});
  const RoadUsers known = seen.known();
  const Body anywhere = settled(likely_box(M_PI / 2.0, observation, kConfig), {20.0, 0.0}, observation).body;
  const Body here = settled(likely_box(M_PI / 2.0, observation, kConfig, known), {20.0, 0.0}, observation).body;
  EXPECT_NEAR(here.length.value_m, 4.8, 0.05) << "only the back of it is seen";
  EXPECT_LT(here.length.variance_m2, 0.25 * anywhere.length.variance_m2);
  Body longer = here;
  longer.length_evidence = {5.4, {5.6, 0.004}};
  EXPECT_NEAR(with_likely_sizes(longer, kConfig).length.value_m, 5.6, 0.1) << "one from elsewhere";
}

TEST(Body, OfAModelIsMeasuredAsThatOfACarIs) {
  const auto points = echoes_of({8.0, 4.0}, 4.6, 1.9);
  const BodyMeasurement car = settled(likely_box(0.0, observation_of(points), kConfig), {8.0, 4.0}, observation_of(points));
  const double scale = 0.1;
  TrackingConfig config;
  config.size_scale = scale;
  for (double* length_m : {&config.range_noise_m, &config.shape_noise_m, &config.longest_body_m}) *length_m *= scale;
  std::vector<Vector2d> model_points;
  for (const Vector2d& point : points) model_points.push_back(scale * point);
  const Observation observation = observation_of(model_points);
  const BodyMeasurement model = settled(likely_box(0.0, observation, config), scale * Vector2d(8.0, 4.0), observation, config);
  EXPECT_NEAR(model.body.length.value_m, scale * car.body.length.value_m, 1e-3);
  EXPECT_NEAR(model.body.width.value_m, scale * car.body.width.value_m, 1e-3);
  EXPECT_LT((model.centre_m - scale * car.centre_m).norm(), 1e-3);
}

TEST(Body, DoesNotShrinkToThePartThatSomethingNearerLeavesInView) {
  auto points = echoes_of({8.0, 12.0}, 5.2, 1.9);
  Body body = settled(likely_box(0.0, observation_of(points), kConfig), {8.0, 12.0}, observation_of(points)).body;
  points.resize(points.size() / 2);
  Observation half = observation_of(points);
  half.end = Edge::kHidden;
  const BodyMeasurement measurement = settled(body, {8.0, 12.0}, half);
  EXPECT_NEAR(measurement.body.length.value_m, 5.2, 0.2);
}

TEST(Body, IsNotTakenToEndWhereSomethingNearerCutsItsFlankOff) {
  auto points = echoes_of({2.0, 4.0}, 4.5, 1.8);
  std::erase_if(points, [](const Vector2d& point) { return point.x() < 1.5 || point.y() > 3.2; });  // the rear half of the flank
  Observation observation = observation_of(points);
  observation.start = Edge::kHidden;
  observation.end = Edge::kHidden;
  observation.laser_m = {-2.0, 0.0};  // beyond the low end, where a face would look at it
  (points.front().x() > points.back().x() ? observation.start : observation.end) = Edge::kOpen;
  Body body = likely_box(0.0, observation_of(echoes_of({2.0, 4.0}, 4.5, 1.8)), kConfig);
  body.is_oriented = true;
  const BodyMeasurement measurement = measure_box(body, {2.0, 4.0}, observation, kConfig);
  EXPECT_NEAR(measurement.centre_m.x(), 2.0, 0.3);
}

TEST(Body, EndsWhereAFlankDoesThoughNothingFartherIsEchoedBeyond) {
  const auto points = echoes_of({8.0, 4.0}, 1.7, 0.6);  // a bicycle at the roadside, in the open
  Observation observation = observation_of(points);
  observation.start = observation.end = Edge::kNoEcho;
  Body body;
  body.has_sides = true;
  const BodyMeasurement measurement = settled(with_likely_sizes(body, kConfig), {8.0, 4.0}, observation);  // a car, as far as known
  EXPECT_EQ(measurement.body.kind, Kind::kBicycle);
  EXPECT_NEAR(measurement.body.length.value_m, 1.7, 0.2);
}

TEST(Body, IsNotBelievedToBeAPieceThatNothingOnTheRoadIsLike) {
  Body body;
  body.has_sides = body.is_oriented = true;
  body.width_evidence = {2.4, {2.5, 0.01}};
  body.length_evidence = {1.8, {2.0, 0.01}};  // as wide as a bus and as long as a bicycle
  body = with_likely_sizes(body, kConfig);
  EXPECT_TRUE(body.kind == Kind::kTruck || body.kind == Kind::kBus);
  EXPECT_GT(body.length.value_m, 5.0);
  EXPECT_GT(body.length.variance_m2, 1.0);
}

TEST(Body, ForgetsThatItWasLargerOnceWhenItIsSeenFromEndToEndAgainAndAgain) {
  const auto points = echoes_of({8.0, 12.0}, 4.5, 1.8);
  Body body;
  body.has_sides = body.is_oriented = true;
  body.length_evidence.least_m = 10.0;  // for a moment a wall was taken for a part of it
  body = with_likely_sizes(body, kConfig);
  ASSERT_GT(body.length.value_m, 9.0);
  for (int scan = 0; scan < 150; ++scan) body = measure_box(body, {8.0, 12.0}, observation_of(points), kConfig).body;
  EXPECT_NEAR(body.length.value_m, 4.5, 0.3);
}

TEST(Body, DoesNotLearnItsWidthBetterFromManyScansThatAllSeeItFromFarAway) {
  const auto points = echoes_of({57.0, 0.0}, 4.5, 1.8);  // four echoes, half a metre apart
  Body body;
  body.has_sides = body.is_oriented = true;
  body = with_likely_sizes(body, kConfig);
  for (int scan = 0; scan < 100; ++scan) body = measure_box(body, {57.0, 0.0}, observation_of(points), kConfig).body;
  EXPECT_GT(std::sqrt(body.width_evidence.whole.variance_m2), 0.1);
}

TEST(Body, KeepsTheSideThatIsSeenWhereItIsWhenItGrows) {
  Body body;
  body.has_sides = body.is_oriented = true;
  body = with_likely_sizes(body, kConfig);
  const Vector2d centre_m{20.0, 0.0};
  const double back_m = centre_m.x() - 0.5 * body.length.value_m;
  std::vector<Vector2d> points;
  for (double y = -1.25; y <= 1.25; y += 0.1) points.emplace_back(back_m, y);  // wider than a car
  const BodyMeasurement measurement = measure_box(body, centre_m, observation_of(points), kConfig);
  ASSERT_GT(measurement.body.length.value_m, body.length.value_m + 1.0);
  EXPECT_NEAR((centre_m + measurement.recentring_m).x() - 0.5 * measurement.body.length.value_m, back_m, 1e-6);
}

/// A car of which only the flank is seen, at heading 0 before a laser at the origin that lies beyond its low end.
Body car_of_unknown_length() {
  Body body;
  body.has_sides = body.is_oriented = true;
  return with_likely_sizes(body, kConfig);
}

Observation with_edges(const std::vector<Vector2d>& points, Edge low, Edge high) {
  Observation observation = observation_of(points);
  const bool begins_low = points.front().x() < points.back().x();
  observation.start = begins_low ? low : high;
  observation.end = begins_low ? high : low;
  return observation;
}

TEST(Body, SaysThatItsCentreMakesAStepWhenAnotherEndOfItIsSeen) {
  std::vector<Vector2d> flank;
  for (double x = 8.0; x < 9.6; x += 0.1) flank.emplace_back(x, 3.0);
  const Vector2d centre_m{9.0, 3.9};
  Body body = car_of_unknown_length();
  const Observation far_end = with_edges(flank, Edge::kHidden, Edge::kOpen);
  const BodyMeasurement first = measure_box(body, centre_m, far_end, kConfig);
  EXPECT_EQ(first.body.length_held, 1);
  EXPECT_TRUE(first.step_covariance_m2.isZero());
  EXPECT_TRUE(measure_box(first.body, centre_m, far_end, kConfig).step_covariance_m2.isZero());
  const BodyMeasurement second = measure_box(first.body, centre_m, with_edges(flank, Edge::kOpen, Edge::kHidden), kConfig);
  EXPECT_EQ(second.body.length_held, -1);
  EXPECT_NEAR(second.step_covariance_m2(0, 0), second.body.length.variance_m2, 1e-9);
  EXPECT_GT(second.body.length.variance_m2, 0.1);
}

TEST(Body, TurnedAboutIsHeldAtTheEndAtWhichItWas) {
  Body body = car_of_unknown_length();
  body.length_held = 1;
  const Body turned = turned_about(body);
  EXPECT_NEAR(std::cos(turned.heading_rad - body.heading_rad), -1.0, 1e-9);
  EXPECT_EQ(turned.length_held, -1);
  EXPECT_FALSE(turned.width_held.has_value());
}

TEST(Body, OfWhichFewBeamsAreAnsweredDoesNotEndAtALoneEcho) {
  const std::vector<Vector2d> echo = {{9.0, 3.0}};
  Observation observation = with_edges(echo, Edge::kNoEcho, Edge::kNoEcho);
  const Vector2d centre_m{9.0, 3.9};
  const auto sigma_along_m = [&](double unanswered_share) {
    observation.unanswered_share = unanswered_share;
    return std::sqrt(measure_box(car_of_unknown_length(), centre_m, observation, kConfig).covariance_m2(0, 0));
  };
  EXPECT_LT(sigma_along_m(0.05), 0.3);
  EXPECT_GT(sigma_along_m(0.75), 1.0);
}

TEST(Body, WithoutSidesIsSomewhereAboutAnEchoThatIsRarelyAnswered) {
  const std::vector<Vector2d> echo = {{25.0, 0.0}};
  Observation observation = observation_of(echo);
  const auto sigma_m = [&](double unanswered_share) {
    observation.unanswered_share = unanswered_share;
    return std::sqrt(measure_blob({}, observation, kConfig).covariance_m2(1, 1));
  };
  EXPECT_LT(sigma_m(0.05), 0.1);
  EXPECT_GT(sigma_m(0.75), 0.35);
}

TEST(Body, WithoutSidesWasSeenWholeOnceNothingHasHiddenAnEndOfIt) {
  const std::vector<Vector2d> echoes = {{25.0, -0.2}, {25.0, 0.0}, {25.0, 0.2}};
  const Body hidden = measure_blob({}, with_edges(echoes, Edge::kHidden, Edge::kOpen), kConfig).body;
  const Body vague = measure_blob(hidden, with_edges(echoes, Edge::kNoEcho, Edge::kOpen), kConfig).body;
  EXPECT_FALSE(vague.was_seen_whole);
  const Body whole = measure_blob(vague, with_edges(echoes, Edge::kOpen, Edge::kOpen), kConfig).body;
  EXPECT_TRUE(measure_blob(whole, with_edges(echoes, Edge::kHidden, Edge::kOpen), kConfig).body.was_seen_whole);
}

TEST(Body, OfWhichMoreWasSeenThanWasTakenForTheWholeWasSeenInPieces) {
  Body body;
  body.has_sides = body.is_oriented = true;
  body.width_evidence = {2.4, {2.45, 0.01}};
  body.length_evidence = {8.8, {6.6, 0.04}};  // a bus, the rear of which something hid
  body = with_likely_sizes(body, kConfig);
  EXPECT_EQ(body.kind, Kind::kBus);
  EXPECT_GT(body.length.value_m, 11.0);
  EXPECT_GT(std::sqrt(body.length.variance_m2), 1.0) << "nothing tells how long it is but what buses are";
}

/// Echoes of a round body as a laser at the origin gets them.
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

TEST(Body, OfLegsOrACoatHasItsMiddleWithinAFewCentimetres) {
  const Vector2d centre_m{6.0, 1.0};
  for (const double radius_m : {0.07, 0.125}) {
    const auto echoes = echoes_of_disc(centre_m, radius_m);
    EXPECT_LT((measure_blob({}, observation_of(echoes), kConfig).centre_m - centre_m).norm(), 0.03) << radius_m;
  }
}

TEST(Body, OfSomethingSmallIsAsDeepAsTheScaleSays) {
  TrackingConfig config;
  config.size_scale = 0.1;
  const Vector2d centre_m{2.0, 0.3};
  const auto echoes = echoes_of_disc(centre_m, 0.01);
  EXPECT_LT((measure_blob({}, observation_of(echoes), config).centre_m - centre_m).norm(), 0.003);
}

TEST(Body, KnowsTheLengthAsItsWidthAfterAQuarterTurn) {
  Body body;
  body.has_sides = true;
  body.length_evidence.least_m = 1.9;
  body = with_likely_sizes(body, kConfig);
  const Body turned = turned_by_a_quarter(body, 1.0, kConfig);
  EXPECT_NEAR(std::abs(std::sin(turned.heading_rad)), 1.0, 1e-9);
  EXPECT_GE(turned.width.value_m, 1.9);
  EXPECT_GT(turned.length.value_m, turned.width.value_m);
}

TEST(Body, ScalesWithTheRoadUsersOfALaboratory) {
  TrackingConfig model_cars;
  model_cars.size_scale = 0.1;
  Body body;
  body.has_sides = true;
  EXPECT_NEAR(with_likely_sizes(body, model_cars).length.value_m, 0.1 * with_likely_sizes(body, kConfig).length.value_m, 1e-5);
}

TEST(Body, OfTwoThingsThatAreNoneOnTheRoadIsNotPlausible) {
  Body body;
  body.has_sides = true;
  EXPECT_TRUE(is_plausible(body, kConfig));
  body.width_evidence.least_m = 4.0;
  EXPECT_FALSE(is_plausible(body, kConfig));
}

TEST(OffsetFromBox, IsZeroInsideAndLeadsFromTheNearestSideOutside) {
  Body body;
  body.heading_rad = M_PI / 2.0;
  body.length.value_m = 4.0;
  body.width.value_m = 2.0;
  EXPECT_TRUE(offset_from_box(body, {1.0, 1.0}, 0.0, {1.5, 2.5}).isZero());
  const Vector2d outside = offset_from_box(body, {1.0, 1.0}, 0.0, {4.0, 1.0});
  EXPECT_NEAR(outside.x(), 2.0, 1e-9);
  EXPECT_NEAR(outside.y(), 0.0, 1e-9);
}

}  // namespace
}  // namespace slammot::tracking
