#include "services/tracking/track.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

constexpr double kPeriodS = 0.027;

TEST(ResponseRate, AreSupposedToBeManyBeforeAnythingIsKnown) { EXPECT_LT(ResponseRate().unanswered_share(), 0.3); }

TEST(ResponseRate, OfSomethingDarkAreStillKnownToBeFewWhenOneEchoIsAllThatIsSeen) {
  ResponseRate responses;
  for (int scan = 0; scan < 20; ++scan) responses = with_responses(responses, 4, 8, kPeriodS);
  responses = with_responses(responses, 1, 0, kPeriodS);
  EXPECT_NEAR(responses.unanswered_share(), 0.8, 0.05);  // of the ten between the two outermost
}

TEST(ResponseRate, AreForgottenAfterAWhile) {
  ResponseRate responses = with_responses({}, 4, 8, kPeriodS);
  for (int scan = 0; scan < 200; ++scan) responses = with_responses(responses, 10, 0, kPeriodS);
  EXPECT_LT(responses.unanswered_share(), 0.05);
}

/// What is learned of one who is always so far from where they were predicted.
double sigma_after_m(double innovation_m, const TrackingConfig& config) {
  const Eigen::Matrix2d noise_m2 = 1e-4 * Eigen::Matrix2d::Identity();
  Gait gait;
  for (int scan = 0; scan < 250; ++scan) gait = with_step(gait, {innovation_m, innovation_m}, noise_m2, kPeriodS, config);
  return std::sqrt(*gait.variance_m2);
}

TEST(Gait, IsThatOfLegsUntilLessOrMoreIsSeen) {
  const TrackingConfig config;
  EXPECT_NEAR(sigma_after_m(0.07, config), 0.07, 0.01);
  EXPECT_NEAR(sigma_after_m(0.0, config), std::sqrt(0.125) * config.gait_noise_m, 1e-12);
  EXPECT_NEAR(sigma_after_m(0.2, config), 0.2, 0.01);
  EXPECT_NEAR(sigma_after_m(1.0, config), 3.0 * config.gait_noise_m, 1e-12) << "nobody who walks";
}

TEST(Gait, IsNeverLessThanThatOfLegsWhereOnlyPeopleMove) {
  TrackingConfig config;
  config.longest_body_m = 2.0;
  EXPECT_NEAR(sigma_after_m(0.0, config), config.gait_noise_m, 1e-12);
  EXPECT_NEAR(sigma_after_m(0.2, config), 0.2, 0.01);
}

TEST(Gait, IsInThePublishedCovarianceAsFarAsItIsSeen) {
  const TrackingConfig config;
  Track track;
  track.estimate.mean << 10.0, 0.0, 1.3, 0.0, 0.0, 0.0;
  track.estimate.covariance = 0.01 * track.estimate.covariance.Identity();
  const Eigen::Matrix4d by_legs = published(track, 0, config).covariance;
  track.gait.variance_m2 = 0.25 * config.gait_noise_m * config.gait_noise_m;
  const Eigen::Matrix4d by_a_coat = published(track, 0, config).covariance;
  EXPECT_NEAR(by_legs(0, 0) - by_a_coat(0, 0), 0.75 * 0.01, 1e-9);
  EXPECT_EQ(by_legs(2, 2), by_a_coat(2, 2));
}

/// Followed for so long, to be a person in a coat, of whom less swings than the settings take for it.
Track walker_in_a_coat(double followed_s, const TrackingConfig& config) {
  Track track;
  track.confirmed = true;
  track.estimate.mean << 10.0, 0.0, 1.3, 0.0, 0.0, 0.0;
  track.estimate.covariance = 0.01 * track.estimate.covariance.Identity();
  track.gait.variance_m2 = std::pow(0.3 * config.gait_noise_m, 2);
  track.last_seen_ns = static_cast<std::int64_t>(followed_s * 1e9);
  return track;
}

TEST(Gait, OfThoseWhoWalkedHereIsThatOfWhoComes) {
  const TrackingConfig config;
  RoadUsersSeen seen;
  for (int i = 0; i < 20; ++i) learn_gait(seen, walker_in_a_coat(5.0, config), config);
  EXPECT_NEAR(seen.known().swing_share, 0.3, 0.1);
  Track newcomer = walker_in_a_coat(0.1, config);
  newcomer.gait.variance_m2.reset();
  const double as_taken_m2 = published(newcomer, 0, config).covariance(0, 0);
  const RoadUsers known = seen.known();
  newcomer.body.road_users = &known;
  EXPECT_LT(published(newcomer, 0, config).covariance(0, 0), as_taken_m2 - 0.008);
}

TEST(Gait, IsLearnedOfThoseOnlyWhoWereFollowedForAWhileAndNotWhereOnlyPeopleMove) {
  const TrackingConfig config;
  RoadUsersSeen seen;
  for (int i = 0; i < 20; ++i) learn_gait(seen, walker_in_a_coat(1.0, config), config);
  TrackingConfig indoors;
  indoors.longest_body_m = 2.0;
  for (int i = 0; i < 20; ++i) learn_gait(seen, walker_in_a_coat(5.0, indoors), indoors);
  EXPECT_EQ(seen.known().swing_share, 1.0);
}

/// Believed in, on its way, and known to be a car.
Track followed_car() {
  Track track;
  track.confirmed = true;
  track.score = 5.0;
  track.travelled_m = 10.0;
  track.body.has_sides = true;
  track.body.length = {4.4, 0.04};
  track.body.width = {1.8, 0.01};
  track.estimate.mean << 20.0, 0.0, 5.0, 0.0, 0.0, 0.0;
  track.estimate.covariance = 0.01 * track.estimate.covariance.Identity();
  return track;
}

/// A car drawn where its echoes are not.
Track misdrawn_car() {
  Track track = followed_car();
  track.consistency = {0.4, 9.0, 10.0};
  return track;
}

TEST(Track, IsWrongOfTwoDrawnOverEachOtherIfItsEchoesAreNotWhereItIs) {
  const TrackingConfig config;
  const Track right = followed_car();
  const Track wrong = misdrawn_car();
  EXPECT_EQ(inconsistent_one(right, wrong, config), &wrong);
  EXPECT_EQ(inconsistent_one(wrong, right, config), &wrong);
  EXPECT_EQ(inconsistent_one(right, right, config), nullptr);
  EXPECT_EQ(inconsistent_one(wrong, wrong, config), nullptr);
  Track small;
  EXPECT_EQ(inconsistent_one(wrong, small, config), nullptr) << "what has no sides may be an echo of anything";
}

TEST(Track, IsFollowedButNotPublishedWhileItsVelocityIsHardlyKnown) {
  const TrackingConfig config;
  Track track = followed_car();
  EXPECT_TRUE(published(track, 0, config).confirmed);
  track.estimate.covariance.block<2, 2>(2, 2) = 1.0 * Eigen::Matrix2d::Identity();
  EXPECT_FALSE(published(track, 0, config).confirmed);
  EXPECT_TRUE(track.confirmed);
}

/// One sigma of the published centre, across the heading.
double sigma_across_m(const Track& track) { return std::sqrt(published(track, 0, TrackingConfig()).covariance(1, 1)); }

TEST(Track, WhoseVelocityWasUnknownIsNotPublishedWhileItComesFromElsewhereThanItShould) {
  const TrackingConfig config;
  Track track = followed_car();
  track.consistency.nis = 6.0;
  EXPECT_TRUE(published(track, 0, config).confirmed) << "it has been seen all the time";
  track.velocity_known_since_ns = 1;
  EXPECT_FALSE(published(track, 0, config).confirmed);
  track.consistency.nis = 3.0;
  EXPECT_TRUE(published(track, 0, config).confirmed);
}

TEST(Track, IsPublishedWithWhatItsHeadingDoesToTheCentreBehindTheSidesThatAreSeen) {
  Track track = followed_car();
  track.body.is_oriented = true;
  track.body.axis_variance_rad2 = 0.001;
  track.body.heading_variance_rad2 = 0.1 * 0.1;
  const double surely_m = sigma_across_m(track);
  track.body.heading_variance_rad2 = 0.1 * 0.1 + 0.3 * 0.3;
  EXPECT_NEAR(sigma_across_m(track), std::hypot(surely_m, 0.3 * 2.2), 1e-6);
}

TEST(Track, MayBeTheFrameOrTheRiderOfABicycle) {
  Track track = followed_car();
  track.body.is_oriented = true;
  track.body.axis_variance_rad2 = 0.001;
  const double of_a_car_m = sigma_across_m(track);
  track.body.kind = Kind::kBicycle;
  EXPECT_GT(sigma_across_m(track), std::hypot(of_a_car_m, 0.1));
}

TEST(Track, DrawnAsACarMayBeTheBicycleThatItsSpeedSaysItIs) {
  Track track = followed_car();
  track.body.is_oriented = true;
  track.body.axis_variance_rad2 = 0.001;
  track.class_probability = {0.0, 0.0, 1.0, 0.0};
  const double surely_m = sigma_across_m(track);
  track.class_probability = {0.0, 0.5, 0.5, 0.0};
  EXPECT_NEAR(sigma_across_m(track), std::hypot(surely_m, std::sqrt(0.5) * 0.5 * (1.8 - 0.65)), 1e-3);
}

TEST(Track, OfWhichNoSideTellsTheHeadingIsNotPublishedAsIfItsCourseDidSurely) {
  Track track = followed_car();
  track.body.is_oriented = true;
  track.body.heading_variance_rad2 = 0.02 * 0.02;
  track.body.axis_variance_rad2 = 0.001;
  EXPECT_LT(sigma_across_m(track), 0.2);
  track.body.axis_variance_rad2 = 10.0;
  EXPECT_GT(sigma_across_m(track), 0.2);
}

TEST(Track, ThatIsTooFastForLegsIsNobodyWhoWalksFromTheFirstScanOn) {
  const TrackingConfig config;
  Track corner;
  corner.body.length = corner.body.width = {0.5, 1.0};
  corner.estimate.mean << 20.0, 0.0, 9.0, 0.0, 0.0, 0.0;
  corner.estimate.covariance = 0.04 * corner.estimate.covariance.Identity();
  confirm(corner, 0, config);
  EXPECT_TRUE(corner.confirmed);
  EXPECT_EQ(corner.object_class, flow::ObjectClass::kCar);
  EXPECT_GT(std::sqrt(published(corner, 0, config).covariance(0, 0)), 1.5);  // its middle may be half a car away
}

TEST(Track, OfAVehicleThatHasComeMayStandForAsLongAsItIsSeen) {
  const TrackingConfig config;
  constexpr std::int64_t kMinuteNs = 60'000'000'000;
  Track track = followed_car();
  track.travelled_m = 2.0;
  track.last_seen_ns = kMinuteNs;
  EXPECT_FALSE(has_stood_too_long(track, kMinuteNs, config));
  EXPECT_TRUE(has_stood_too_long(track, kMinuteNs + 3'000'000'000, config));  // where has it been since?
  track.travelled_m = 1.0;  // it may be a wall of which more and more came into view
  EXPECT_TRUE(has_stood_too_long(track, kMinuteNs, config));
  track.travelled_m = 2.0;
  track.body.has_sides = false;
  EXPECT_TRUE(has_stood_too_long(track, kMinuteNs, config));
}

TEST(Track, IsBelievedInLessWhereMoreBeamsPassThroughTheMiddleOfItThanAreEchoed) {
  const TrackingConfig config;
  const Visibility seen{10, 0, 8, 0};
  Track track = followed_car();
  track.mapped_share = 0.5;
  score_passed(track, seen, 8, config);
  EXPECT_EQ(track.score, 5.0);
  score_passed(track, seen, 2, config);
  EXPECT_LT(track.score, 4.0);
}

TEST(Track, OfWhatTheMapContradictsIsSomethingThoughItIsDrawnTooLarge) {
  Track track = followed_car();
  track.mapped_share = 0.0;
  score_passed(track, {10, 0, 8, 0}, 2, {});
  EXPECT_EQ(track.score, 5.0);
}

TEST(Track, IsFilledInTheMiddleAsFarAsItsSizeAndPlaceAreKnown) {
  Track track = followed_car();
  EXPECT_NEAR(inner_part_of(track).length.value_m, 4.4 - 0.2 - 2.0 * 0.1, 1e-9);
  EXPECT_NEAR(inner_part_of(track).width.value_m, 1.8 - 0.1 - 2.0 * 0.1, 1e-9);
  track.body.length.variance_m2 = 9.0;
  EXPECT_GT(inner_part_of(track).length.value_m, 0.0);
}

/// After a scan with two echoes of a car that was going at this velocity, its axis known to this.
Track car_after_two_echoes(double axis_sigma_rad, const Eigen::Vector2d& velocity_mps, double velocity_sigma_mps, bool is_oriented) {
  const TrackingConfig config;
  Track track = followed_car();
  track.body = with_likely_sizes(track.body, config);
  track.body.is_oriented = is_oriented;
  track.body.heading_rad = track.body.axis_rad = 0.0;
  track.body.heading_variance_rad2 = 1e-4;
  track.body.axis_variance_rad2 = axis_sigma_rad * axis_sigma_rad;
  filters::MotionState state;
  state.mean << 20.0, 0.0, velocity_mps.x(), velocity_mps.y(), 0.0, 0.0;
  state.covariance = velocity_sigma_mps * velocity_sigma_mps * filters::Matrix6::Identity();
  move_as(track, state, config);
  const std::vector<Eigen::Vector2d> points = {{17.8, -0.2}, {17.8, 0.2}};
  Observation observation;
  observation.points_m = points;
  observation.beam_step_rad = 0.5 * M_PI / 180.0;
  EXPECT_TRUE(update(track, 27'000'000, observation, 1e-4 * Eigen::Matrix2d::Identity(), config));
  return track;
}

TEST(Track, IsSteeredForAsLongAsItsAxisTellsWhichSideIsTheFlankButLessWhileNoSideTellsTheAxis) {
  const auto speed_across_mps = [](double axis_sigma_rad) { return car_after_two_echoes(axis_sigma_rad, {3.0, 1.5}, 1.0, true).velocity_mps().y(); };
  const double told_mps = speed_across_mps(0.13);
  const double remembered_mps = speed_across_mps(0.24);
  EXPECT_GT(remembered_mps, told_mps + 0.5);
  EXPECT_LT(remembered_mps, speed_across_mps(0.3) - 0.1);
}

TEST(Track, IsNotOrientedByACourseHalfwayBetweenTwoSidesForAsLongAsItsAxisTellsThem) {
  const auto is_oriented = [](double axis_sigma_rad) { return car_after_two_echoes(axis_sigma_rad, {4.0, 4.0}, 0.3, false).body.is_oriented; };
  EXPECT_FALSE(is_oriented(0.24));
  EXPECT_TRUE(is_oriented(0.3));
}

/// A rear, as wide as one of a car and so deep, at which so much is added to the place now and then.
double score_after_two_seconds(double depth_m, double jump_m) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points;
  Observation observation;
  observation.beam_step_rad = 0.5 * M_PI / 180.0;
  Track track;
  std::int64_t stamp_ns = 0;
  for (int scan = 0; scan < 74; ++scan) {
    points.clear();
    const double x_m = 20.0 + 5.0 * kPeriodS * scan + (scan % 2 == 0 ? jump_m : 0.0);
    for (int i = 0; i < 10; ++i) points.emplace_back(x_m + depth_m * (i % 3) / 2.0, -0.9 + 0.2 * i);
    observation.points_m = points;
    if (scan == 0) track = initiated({1}, stamp_ns, observation, 0.0, 1e-4 * Eigen::Matrix2d::Identity(), config);
    predict(track, scan == 0 ? 0.0 : kPeriodS, config);
    EXPECT_TRUE(update(track, stamp_ns, observation, 1e-4 * Eigen::Matrix2d::Identity(), config));
    score_hit(track, flow::PointLabel::kMoving, {8.0, 0.0, 2.0}, kPeriodS, config);
    stamp_ns += 27'000'000;
  }
  return track.score;
}

TEST(Track, IsNotBelievedInIfItsEchoesNeitherLieOnItsSidesNorComeFromWhereItShouldBe) {
  EXPECT_GT(score_after_two_seconds(0.0, 0.0), 5.0);
  EXPECT_GT(score_after_two_seconds(0.0, 0.3), 5.0) << "a body like any, for all its jumps";
  EXPECT_GT(score_after_two_seconds(1.5, 0.0), 5.0) << "something, but drawn wrong";
  EXPECT_LT(score_after_two_seconds(1.5, 0.3), 0.0) << "twigs";
}

TEST(Track, DoesNotTurnByWhatIsRound) {
  const TrackingConfig config;
  const std::vector<Eigen::Vector2d> points{{20.0, -0.9}, {20.0, -0.3}, {20.0, 0.3}, {20.0, 0.9}};
  const auto heading_after = [&](double off_m) {
    Observation observation;
    observation.points_m = points;
    observation.beam_step_rad = 0.5 * M_PI / 180.0;
    observation.side = Side{0.5 * M_PI + 0.3, 1.8, off_m};
    Track track = initiated({1}, 0, observation, 0.5 * M_PI, 1e-4 * Eigen::Matrix2d::Identity(), config);
    track.body.heading_rad = 0.0;
    track.body.heading_variance_rad2 = 0.01;
    predict(track, kPeriodS, config);
    EXPECT_TRUE(update(track, 27'000'000, observation, 1e-4 * Eigen::Matrix2d::Identity(), config));
    return track.body.heading_rad;
  };
  EXPECT_GT(heading_after(0.01), 0.1);
  EXPECT_NEAR(heading_after(0.15), 0.0, 0.03);
}

TEST(Track, MayTurnTheFasterTheSmallerItIs) {
  const std::vector<Eigen::Vector2d> points{{20.0, -0.9}, {20.0, -0.3}, {20.0, 0.3}, {20.0, 0.9}};
  const auto variance_after_a_second = [&](double size_scale) {
    TrackingConfig config;
    config.size_scale = size_scale;
    Observation observation;
    observation.points_m = points;
    observation.beam_step_rad = 0.5 * M_PI / 180.0;
    Track track = initiated({1}, 0, observation, 0.5 * M_PI, 1e-4 * Eigen::Matrix2d::Identity(), config);
    track.body.heading_variance_rad2 = track.body.axis_variance_rad2 = 0.0;
    predict(track, 1.0, config);
    EXPECT_EQ(track.body.axis_variance_rad2, track.body.heading_variance_rad2);
    return track.body.heading_variance_rad2;
  };
  EXPECT_GT(variance_after_a_second(1.0), 0.0);
  EXPECT_NEAR(variance_after_a_second(0.1), 10.0 * variance_after_a_second(1.0), 1e-9);
}

TEST(Track, LiesAlongWhatIsLongerThanAnyFront) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points;
  const auto flank_m = [&](double length_m) {
    points.clear();
    for (double y = 0.0; y < length_m; y += 0.2) points.emplace_back(20.0, y);
    Observation observation;
    observation.points_m = points;
    observation.beam_step_rad = 0.5 * M_PI / 180.0;
    observation.start = observation.end = Edge::kHidden;
    return observation;
  };
  Track track = initiated({1}, 0, flank_m(2.0), 0.5 * M_PI, 1e-4 * Eigen::Matrix2d::Identity(), config);
  ASSERT_LT(std::abs(std::sin(track.body.heading_rad)), 0.1);  // as wide as the rear of a car
  std::int64_t stamp_ns = 0;
  for (int scan = 0; scan < 20; ++scan) {
    predict(track, kPeriodS, config);
    ASSERT_TRUE(update(track, stamp_ns += 27'000'000, flank_m(3.1), 1e-4 * Eigen::Matrix2d::Identity(), config));
  }
  EXPECT_GT(std::abs(std::sin(track.body.heading_rad)), 0.9);
}

TEST(Track, IsDrawnAnewWhereItWouldBeWiderThanAnythingThatGoesItsWay) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points;
  const auto bicycle_at = [&](double x_m) {
    points.clear();
    for (double x = 0.0; x < 1.7; x += 0.3) points.emplace_back(x_m + x, 8.0);
    Observation observation;
    observation.points_m = points;
    observation.beam_step_rad = 0.5 * M_PI / 180.0;
    return observation;
  };
  Track track = initiated({1}, 0, bicycle_at(10.0), 0.0, 1e-4 * Eigen::Matrix2d::Identity(), config);
  track.body.heading_rad = 0.5 * M_PI;
  track.body.length_evidence.least_m = 4.1;  // once a parked car was taken for a part of it
  track.body.width_evidence.least_m = 1.7;
  track.body = with_likely_sizes(track.body, config);
  restart_motion(track, {5.5, 0.0}, 0.3, config);
  track.confirmed = true;
  for (int scan = 1; scan < 10; ++scan) {
    predict(track, kPeriodS, config);
    update(track, scan * 27'000'000, bicycle_at(10.0 + 5.5 * kPeriodS * scan), 1e-4 * Eigen::Matrix2d::Identity(), config);
  }
  EXPECT_LT(std::abs(std::sin(track.body.heading_rad)), 0.1);
  EXPECT_LT(track.body.length.value_m, 2.5);
  EXPECT_LT(track.body.width.value_m, 1.0);
}

/// A car seen from behind, of which the sides are known.
Track known_car() {
  Track track;
  track.confirmed = true;
  track.travelled_m = 20.0;
  track.body.has_sides = track.body.is_oriented = true;
  track.body.length_evidence = {4.5, {4.6, 0.004}};
  track.body.width_evidence = {1.7, {1.8, 0.004}};
  track.body.corner_seen = {0.1, 0.001};
  track.body.heading_variance_rad2 = 0.0016;
  track.body.axis_variance_rad2 = 0.0016;
  track.body = with_likely_sizes(track.body, {});
  track.motion = filters::imm_start(motion_models({}), track.estimate);
  return track;
}

TEST(Track, IsKnownAcrossAsWellAsItsSidesKeepTheirHeading) {
  HeadingNoise straight;
  HeadingNoise swaying;
  for (int i = 0; i < 200; ++i) {
    straight = with_heading(straight, 0.005, 0.0025, kPeriodS);
    swaying = with_heading(swaying, 0.05, 0.0025, kPeriodS);
  }
  EXPECT_LT(straight.share, 0.1);
  EXPECT_NEAR(swaying.share, 1.0, 0.05);
  Track track = known_car();
  const double as_taken_m2 = published(track, 0, {}).covariance(1, 1);
  track.heading_noise = straight;
  EXPECT_LT(published(track, 0, {}).covariance(1, 1), as_taken_m2 - 0.004);
  track.body.axis_variance_rad2 = 1.0;
  EXPECT_GT(published(track, 0, {}).covariance(1, 1), as_taken_m2) << "no side tells the heading";
}

TEST(Track, IsAsWideAsLiesBetweenWhatWasSeenFromEdgeToEdgeAndTheMostThatWasSeen) {
  RoadUsersSeen seen;
  Track track = known_car();
  track.body.width_evidence = {1.95, {1.65, 0.004}};
  for (int i = 0; i < 40; ++i) learn_sizes(seen, track, {});
  EXPECT_NEAR(seen.known().kinds[1].width_m, 1.8, 0.03);
}

TEST(Track, IsOneOfThoseHereIfItsSizesAreSurelyKnown) {
  const auto length_sigma_m_after = [](const Track& track) {
    RoadUsersSeen seen;
    for (int i = 0; i < 10; ++i) learn_sizes(seen, track, {});
    return seen.known().kinds[1].length_sigma_m;
  };
  const double unknown_m = RoadUsersSeen().known().kinds[1].length_sigma_m;
  EXPECT_LT(length_sigma_m_after(known_car()), 0.7 * unknown_m);
  Track other = known_car();
  other.confirmed = false;
  EXPECT_EQ(length_sigma_m_after(other), unknown_m);
  other = known_car();
  other.travelled_m = 0.0;
  EXPECT_EQ(length_sigma_m_after(other), unknown_m) << "a piece of something";
  other = known_car();
  other.body.length_evidence.whole = {0.0, 1e6};
  other.body = with_likely_sizes(other.body, {});
  EXPECT_EQ(length_sigma_m_after(other), unknown_m) << "only its back was seen";
}

Eigen::Matrix4d published_covariance(const Track& track) { return published(track, 0, {}).covariance; }

TEST(Track, IsKnownAsWellAsBodiesHereAreBoxes) {
  Track track = known_car();
  track.estimate.covariance = 0.0009 * track.estimate.covariance.Identity();
  track.range_m = 5.0;
  const Eigen::Matrix4d as_taken = published_covariance(track);
  RoadUsers of_boxes_here;
  of_boxes_here.shape_share = 0.4;
  track.body.road_users = &of_boxes_here;
  const Eigen::Matrix4d of_boxes = published_covariance(track);
  EXPECT_LT(of_boxes(0, 0), as_taken(0, 0) - 0.0007);
  EXPECT_LT(of_boxes(1, 1), as_taken(1, 1) - 0.006);
  EXPECT_EQ(of_boxes(2, 2), as_taken(2, 2));
  track.range_m = 50.0;
  EXPECT_GT(published_covariance(track)(0, 0), of_boxes(0, 0) + 0.0002) << "the scanner errs as it did";
  track.body.axis_variance_rad2 = 1.0;
  EXPECT_GT(published_covariance(track)(1, 1), as_taken(1, 1)) << "no side tells the heading";
}

TEST(Track, MayBeAnywhereInItsBoxWhereBeamsPassThroughIt) {
  Track track = known_car();
  const Eigen::Matrix4d solid = published_covariance(track);
  for (int i = 0; i < 100; ++i) track.beam_passage = with_beams(track.beam_passage, 1, 19, kPeriodS);
  EXPECT_EQ(published_covariance(track)(0, 0), solid(0, 0)) << "a beam or two pass by a corner";
  for (int i = 0; i < 100; ++i) track.beam_passage = with_beams(track.beam_passage, 16, 4, kPeriodS);
  EXPECT_GT(std::sqrt(published_covariance(track)(0, 0)), 1.0);
  EXPECT_GT(std::sqrt(published_covariance(track)(1, 1)), 0.4);
  for (int i = 0; i < 100; ++i) track.beam_passage = with_beams(track.beam_passage, 0, 20, kPeriodS);
  EXPECT_NEAR(published_covariance(track)(0, 0), solid(0, 0), 1e-3) << "that is over";
}

TEST(Track, MayBeAnywhereInItsBoxWhereEchoesLieFarOffItsSides) {
  Track track = known_car();
  track.range_m = 10.0;
  track.consistency.off_sides_m = 0.05;
  const Eigen::Matrix4d near = published_covariance(track);
  track.consistency.off_sides_m = 0.3;
  EXPECT_GT(std::sqrt(published_covariance(track)(0, 0)), std::sqrt(near(0, 0)) + 0.5);
  track.consistency.off_sides_m = 0.15;
  track.range_m = 50.0;
  EXPECT_LT(std::sqrt(published_covariance(track)(0, 0)), std::sqrt(near(0, 0)) + 0.05) << "far away that is usual";
}

double shape_share_after(const Track& track) {
  RoadUsersSeen seen;
  for (int i = 0; i < 20; ++i) learn_outline_error(seen, track, {});
  return seen.known().shape_share;
}

TEST(Track, TellsHowFarEchoesLieOffVehiclesThatWereFollowedForLong) {
  Track track = known_car();
  track.outline_error = {0.4 * 800.0, 800.0, 40};
  EXPECT_LT(shape_share_after(track), 0.4);
  Track other = track;
  other.outline_error = {0.4 * 80.0, 80.0, 4};
  EXPECT_EQ(shape_share_after(other), 1.0);
  other = track;
  other.travelled_m = 0.0;
  EXPECT_EQ(shape_share_after(other), 1.0) << "a piece of something";
  other = track;
  other.body.kind = Kind::kBicycle;
  EXPECT_EQ(shape_share_after(other), 1.0);
}

TEST(Track, CountsHowFarEchoesLieOffItsSidesWhileItIsAVehicleThatIsConfirmed) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < 12; ++i) points_m.emplace_back(10.0, -0.9 + 1.8 / 11.0 * i);  // the back of a car
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.015;
  Track track = known_car();
  track.estimate.mean.head<2>() = Eigen::Vector2d(12.3, 0.0);
  track.estimate.covariance = 0.01 * track.estimate.covariance.Identity();
  track.motion = filters::imm_start(motion_models(config), track.estimate);
  Track tentative = track;
  tentative.confirmed = false;
  ASSERT_TRUE(update(track, 27'000'000, observation, Eigen::Matrix2d::Zero(), config));
  EXPECT_EQ(track.outline_error.scans, 1);
  EXPECT_EQ(track.outline_error.echoes, 12.0);
  EXPECT_LT(track.outline_error.shares, 12.0);
  EXPECT_NEAR(track.range_m, 12.3, 0.3);
  ASSERT_TRUE(update(tentative, 27'000'000, observation, Eigen::Matrix2d::Zero(), config));
  EXPECT_EQ(tentative.outline_error.scans, 0);
}

/// Followed for long, at 1.3 m/s along x, so far from the laser that lies beside their way.
Track known_walker(double x_m, const TrackingConfig& config) {
  Track track;
  track.confirmed = true;
  track.score = 5.0;
  track.hits = 100;
  track.travelled_m = 5.0;
  track.body.length = {0.5, 0.01};
  track.body.width = {0.5, 0.01};
  track.body.was_seen_whole = true;
  track.largest_extent_m = 0.5;
  for (int i = 0; i < 150; ++i) track.speeds = with_speed(track.speeds, {1.3, 0.2, kPeriodS}, config);
  track.class_probability = class_probabilities(track.body, track.speeds, config);
  filters::MotionState motion;
  motion.mean << x_m, 8.0, 1.3, 0.0, 0.0, 0.0;
  motion.covariance = 0.02 * motion.covariance.Identity();
  move_as(track, motion, config);
  return track;
}

/// One scan later there are echoes of somebody, or of something this wide, about this place.
void see(Track& track, const Eigen::Vector2d& middle_m, double width_m, const TrackingConfig& config) {
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < 7; ++i) points_m.emplace_back(middle_m.x() + width_m * (i / 6.0 - 0.5), middle_m.y() - 0.1);
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.009;
  predict(track, kPeriodS, config);
  ASSERT_TRUE(update(track, track.last_seen_ns + 27'000'000, observation, Eigen::Matrix2d::Zero(), config));
}

TEST(Track, OfOneKnownToWalkGoesOnThoughItIsGivenTheEchoesOfOneWhoComesTowardsThem) {
  const TrackingConfig config;
  Track track = known_walker(0.0, config);
  for (int i = 0; i < 40; ++i) see(track, {1.3 * kPeriodS * (i + 1), 8.0}, 0.4, config);
  ASSERT_TRUE(is_known_pedestrian(track));
  const double met_m = track.position_m().x();
  for (int i = 0; i < 10; ++i) see(track, {met_m + 0.3 - 1.3 * kPeriodS * (i + 1), 7.6}, 0.4, config);
  EXPECT_GT(track.velocity_mps().x(), 0.9);
  EXPECT_LT(std::abs(track.velocity_mps().y()), 0.5);
}

TEST(Track, OfOneKnownToWalkFollowsThemWhenTheyStop) {
  const TrackingConfig config;
  Track track = known_walker(0.0, config);
  for (int i = 0; i < 40; ++i) see(track, {1.3 * kPeriodS * (i + 1), 8.0}, 0.4, config);
  const double stopped_m = 1.3 * kPeriodS * 40;
  for (int i = 0; i < 40; ++i) see(track, {stopped_m, 8.0}, 0.4, config);
  EXPECT_LT(track.velocity_mps().norm(), 0.3);
  EXPECT_NEAR(track.position_m().x(), stopped_m, 0.2);
}

TEST(Track, OfOneKnownToWalkIsSomebodyWhoWalksThoughTheFilterSaysThatTheyFly) {
  const TrackingConfig config;
  const auto noise_m2 = [&](double speed_mps, bool is_known) {
    Track track = known_walker(0.0, config);
    track.hits = is_known ? 100 : 10;
    track.motion.modes[0].mean[2] = track.motion.modes[1].mean[2] = speed_mps;
    see(track, {speed_mps * kPeriodS, 8.0}, 0.4, config);
    return track.measured->R(0, 0);
  };
  EXPECT_LT(noise_m2(3.5, false), 0.3 * noise_m2(1.3, false)) << "no legs swing at that speed";
  EXPECT_NEAR(noise_m2(3.5, true), noise_m2(1.3, true), 0.01);
}

TEST(Track, OfOneKnownToWalkGoesOnAtTheirVelocityWhileHidden) {
  const TrackingConfig config;
  Track track = known_walker(0.0, config);
  for (filters::MotionState& mode : track.motion.modes) mode.mean[4] = -1.5;  // as if they were about to turn round
  for (int i = 0; i < 37; ++i) predict(track, kPeriodS, config);
  EXPECT_NEAR(track.velocity_mps().x(), 1.3, 0.05);
}

TEST(Track, OfOneKnownToWalkGetsNoSides) {
  const TrackingConfig config;
  Track track = known_walker(0.0, config);
  Track other = track;
  other.hits = 10;
  see(track, {1.3 * kPeriodS, 8.0}, 1.5, config);
  see(other, {1.3 * kPeriodS, 8.0}, 1.5, config);
  EXPECT_FALSE(track.body.has_sides);
  EXPECT_TRUE(other.body.has_sides) << "may be a part of something";
}

}  // namespace
}  // namespace slammot::tracking
