#include "services/localization/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/example_submap.hpp"
#include "tests/support/localizer_drive.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using flow::PointLabel;
using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::all_stationary;
using slammot::testing::arc;
using slammot::testing::drive_one;
using slammot::testing::drive_through;
using slammot::testing::DriveErrors;
using slammot::testing::DriveSetup;
using slammot::testing::PoseNear;
using slammot::testing::SimulatedDrive;
using slammot::testing::small_map_config;
using slammot::testing::World;

/// A robot that goes round in a room.
DriveSetup round_in_a_room() {
  return {.world = slammot::testing::room(), .world_from_base_at = arc({0.0, -3.0, 0.0}, 0.5, 0.2)};
}

/// A car with a sweeping scanner at its front bumper, on a road.
DriveSetup along_a_street(double speed_mps = 8.0) {
  DriveSetup setup{.world = slammot::testing::street(120.0),
                   .world_from_base_at = arc({2.0, -1.0, 0.02}, speed_mps, 0.0)};
  setup.scan_period_s = 0.05;
  setup.scanner.base_from_laser = {2.15, 0.0, 0.0};
  setup.scanner.sweep_s = 0.013;
  setup.wheels = {.scale = 1.01, .heading_rate_bias_radps = 0.004};
  return setup;
}

TEST(Localizer, KnowsWhereItIsInARoom) {
  SimulatedDrive drive(round_in_a_room());
  Localizer localizer(small_map_config());
  const DriveErrors errors = drive_through(localizer, drive, 0, 150);
  EXPECT_LT(errors.worst_m, 0.03);
  EXPECT_LT(errors.worst_rad, 0.005);
  EXPECT_EQ(localizer.counters().scans.localized, 150U);
  EXPECT_EQ(localizer.counters().matches.lost, 0U);
}

/// Out of a street between two bare walls.
DriveSetup between_bare_walls() {
  DriveSetup setup = along_a_street();
  setup.world = slammot::testing::joined(slammot::testing::box({5.0, 12.0, 0.3}, 12.0, 4.0),
                                         slammot::testing::box({12.0, -12.0, 0.2}, 9.0, 4.0));
  setup.world = slammot::testing::joined(
      setup.world, {{{-300.0, 8.0}, {500.0, 8.0}}, {{-300.0, -8.0}, {500.0, -8.0}}});
  setup.noise_m = 0.03;
  setup.world_from_base_at = arc({2.0, -1.0, 0.0}, 8.0, 0.0);
  return setup;
}

/// A small car that wriggles through a room, with a scanner that turns all around, the other way
/// round than it says.
DriveSetup with_a_scanner_that_turns_the_other_way(double true_sweep_s) {
  DriveSetup setup{.world = slammot::testing::room()};
  setup.world_from_base_at = [](double time_s) {  // an eight, driven at 0 to 2 m/s
    constexpr double kCircleS = 2.0 * std::numbers::pi;
    const double t = time_s + std::sin(time_s);
    const bool is_left = std::fmod(t, 2.0 * kCircleS) < kCircleS;
    return arc({-3.0, -1.5, 0.0}, 1.0, is_left ? 1.0 : -1.0)(std::fmod(t, kCircleS));
  };
  setup.beams = 360;
  setup.scanner.first_beam_rad = -std::numbers::pi;
  setup.scanner.sweep_s = true_sweep_s;
  return setup;
}

TEST(Localizer, FindsOutThatAScannerTurnsTheOtherWayRound) {
  constexpr double kSaidS = 0.08;
  for (const double truth : {-1.0, 1.0}) {
    SimulatedDrive drive(with_a_scanner_that_turns_the_other_way(truth * kSaidS));
    LocalizerConfig config = small_map_config();
    config.echoes.sweep_factor_sigma = 1.0;
    config.map.surfel_size_m = 0.1;
    config.match.coarse_gate_m = 0.5;
    config.match.fine_gate_m = 0.15;
    config.match.proven_after_m = 0.0;
    config.motion.position_noise_per_m = config.motion.sideways_noise_per_m = 0.03;
    config.motion.askew_prior_rad = 0.0;  // what a sweep does to a scan looks much like it
    Localizer localizer(config);
    double told_s = 0.0;
    for (std::uint32_t number = 0; number < 300; ++number) {
      sensing::LaserScan scan = drive.scan(number);
      scan.scanner.sweep_s = kSaidS;
      localizer.add_odometry(drive.odometry(number));
      const auto localized = localizer.localize(scan);
      ASSERT_TRUE(localized);
      localizer.integrate(all_stationary(*localized));
      told_s = localized->sweep_s;
    }
    EXPECT_NEAR(told_s, truth * kSaidS, 0.15 * kSaidS);
    EXPECT_NEAR(localizer.sweep_factor().value, truth, 0.15);
    EXPECT_LT(localizer.sweep_factor().variance, 0.01);
  }
}

TEST(Localizer, TakesTheSweepForWhatItIsSaidToBeUnlessAsked) {
  SimulatedDrive drive(with_a_scanner_that_turns_the_other_way(0.08));
  Localizer localizer(small_map_config());
  drive_through(localizer, drive, 0, 20);
  EXPECT_EQ(localizer.sweep_factor().value, 1.0);
  EXPECT_EQ(localizer.sweep_factor().variance, 0.0);
}

/// A small car that speeds up, brakes and turns through a room; its wheels are stamped later than
/// the scans.
struct LateWheels {
  double offset_s = 0.0;
  double sigma_s = 0.0;
  bool is_used = false;
  Pose2 odom_from_base;
};

LateWheels after_driving_with_late_wheels(double late_s, double prior_s, int of_samples = 1,
                                          double jump_m = 0.0) {
  DriveSetup setup = with_a_scanner_that_turns_the_other_way(0.0);
  SimulatedDrive drive(setup);
  LocalizerConfig config = small_map_config();
  config.motion.stamp_offset_prior_s = prior_s;
  Localizer localizer(config);
  constexpr int kPerScan = 5;  // samples of the wheels
  std::optional<flow::LocalizedScan> localized_last;
  for (int sample = 0; sample < 400 * kPerScan; ++sample) {
    const double time_s = setup.scan_period_s * sample / kPerScan;
    if (sample % of_samples != 0) continue;  // that many make one, and the scans as well
    Pose2 wheel_from_base = setup.world_from_base_at(std::max(0.0, time_s - late_s));
    if (sample > 300 * kPerScan) wheel_from_base.x_m += jump_m;
    localizer.add_odometry({slammot::testing::stamp_ns_of(time_s), wheel_from_base});
    if (sample % kPerScan != 0) continue;
    const auto localized =
        localizer.localize(drive.scan(static_cast<std::uint32_t>(sample / kPerScan)));
    if (localized) localizer.integrate(all_stationary(*localized));
    localized_last = localized;
  }
  const Pose2 odom_from_base = localized_last ? localized_last->odom_from_base.pose : Pose2{};
  return {localizer.stamp_offset_s(), localizer.stamp_offset_sigma_s(),
          localizer.applies_stamp_offset(), odom_from_base};
}

TEST(Localizer, LearnsByHowMuchLaterTheWheelsAreStampedThanTheScans) {
  for (const double late_s : {0.05, 0.0, -0.05}) {
    const LateWheels learned = after_driving_with_late_wheels(late_s, 0.05);
    EXPECT_LT(learned.sigma_s, 0.01);
    EXPECT_NEAR(learned.offset_s, late_s, 3.0 * learned.sigma_s);
    EXPECT_EQ(learned.is_used, late_s != 0.0);
  }
}

TEST(Localizer, IsTheSameWithAndWithoutLearningStampsThatAreRight) {
  EXPECT_EQ(after_driving_with_late_wheels(0.0, 0.05).odom_from_base,
            after_driving_with_late_wheels(0.0, 0.0).odom_from_base);
}

TEST(Localizer, KeepsWhatItKnowsOfStampsWhereWheelsJump) {
  const LateWheels learned = after_driving_with_late_wheels(0.05, 0.05, 1, 400.0);
  EXPECT_TRUE(learned.is_used);
  EXPECT_GT(learned.sigma_s, 0.0005);  // a jump, taken for a change of the velocity, would tell it
                                       // to microseconds
  EXPECT_NEAR(learned.offset_s, 0.05, 3.0 * learned.sigma_s);
}

TEST(Localizer, LearnsNothingOfStampsWhereScansAreHalfASecondApart) {
  const LateWheels learned = after_driving_with_late_wheels(0.05, 0.05, 25);
  EXPECT_EQ(learned.offset_s, 0.0);
  EXPECT_FALSE(learned.is_used);
}

TEST(Localizer, TakesTheWheelsStampsForTheScansUnlessAsked) {
  const LateWheels learned = after_driving_with_late_wheels(0.05, 0.0);
  EXPECT_EQ(learned.offset_s, 0.0);
  EXPECT_EQ(learned.sigma_s, 0.0);
}

TEST(Localizer, GrowsUnsureAlongBareWallsAndStaysSureAcrossThem) {
  SimulatedDrive drive(between_bare_walls());
  Localizer localizer(LocalizerConfig{});
  std::vector<geometry::Matrix3> covariances;
  Pose2 last;
  for (std::uint32_t scan = 0; scan < 300; ++scan) {
    const auto localized = drive_one(localizer, drive, scan);
    ASSERT_TRUE(localized);
    covariances.push_back(localized->odom_from_base.covariance);
    last = localized->odom_from_base.pose;
  }
  EXPECT_GT(localizer.counters().matches.sampled, 280U);
  EXPECT_EQ(localizer.counters().matches.searches, 0U);  // along a bare wall one place is as good
                                                         // as another
  // 8 m/s: after 40 m, 80 m and 120 m.
  EXPECT_GT(covariances[200](0, 0), 1.5 * covariances[100](0, 0));
  EXPECT_GT(covariances[299](0, 0), 1.2 * covariances[200](0, 0));
  EXPECT_LT(std::sqrt(covariances[299](1, 1)), 0.02);
  const Eigen::Vector3d error = geometry::difference(last, drive.odom_from_base(299));
  EXPECT_LT(std::abs(error.x()), 3.0 * std::sqrt(covariances[299](0, 0)));
  EXPECT_LT(std::abs(error.y()), 0.05);
}

TEST(Localizer, SamplesNothingWhereEveryScanSaysEnough) {
  SimulatedDrive drive(along_a_street());
  Localizer localizer(small_map_config());
  drive_through(localizer, drive, 0, 100);
  EXPECT_EQ(localizer.counters().matches.sampled, 0U);
}

TEST(Localizer, KnowsWhereItIsAfterAHundredMetresOfStreetAndWhatIsWrongWithTheWheels) {
  SimulatedDrive drive(along_a_street());
  Localizer localizer(small_map_config());
  const DriveErrors errors = drive_through(localizer, drive, 0, 250);
  EXPECT_LT(errors.worst_m, 0.25);
  EXPECT_LT(errors.worst_rad, 0.005);
  EXPECT_NEAR(1.0 + localizer.calibration().x(), 1.01, 0.003);
  const double bias_radps = localizer.calibration().y() + 8.0 * localizer.calibration().z();
  EXPECT_NEAR(bias_radps, 0.004, 0.002);
}

/// How far sideways it thinks it has come while standing for 18 s in a street that seems to creep
/// past, by 0.3 mm a scan.
double led_astray_m(const LocalizerConfig& config) {
  constexpr std::uint32_t kDriven = 40;
  constexpr std::uint32_t kStands = kDriven + 20;
  constexpr std::uint32_t kEnd = kStands + 180;
  DriveSetup setup = along_a_street();
  const slammot::testing::Path drives = setup.world_from_base_at;
  const double stops_at_s = kDriven * setup.scan_period_s;
  const double stands_at_s = kStands * setup.scan_period_s;
  setup.world_from_base_at = [=](double time_s) {
    Pose2 pose = drives(std::min(time_s, stops_at_s));
    pose.y_m += 0.003 * std::max(0.0, time_s - stands_at_s);
    return pose;
  };
  SimulatedDrive drive(setup);
  Localizer localizer(config);
  drive_through(localizer, drive, 0, kDriven);
  Pose2 stood;
  Pose2 pose;
  for (std::uint32_t scan = kDriven; scan < kEnd; ++scan) {
    localizer.add_odometry({drive.scan(scan).stamp_ns, drive.odometry(kDriven).wheel_from_base});
    const auto localized = localizer.localize(drive.scan(scan));
    localizer.integrate(all_stationary(*localized));
    pose = localized->odom_from_base.pose;
    if (scan == kStands) stood = pose;
  }
  return std::abs((geometry::inverse(stood) * pose).y_m);
}

TEST(Localizer, StandsWhereItsWheelsStandThoughTheMapSeemsToCreep) {
  constexpr double kCrept_m = 0.027;
  LocalizerConfig may_be_picked_up = small_map_config();
  may_be_picked_up.odometry.may_be_picked_up = true;
  for (const LocalizerConfig& config : {small_map_config(), may_be_picked_up})
    EXPECT_LT(led_astray_m(config), 0.3 * kCrept_m);
}

TEST(Localizer, TellsHowFarTheMapLetsBeamsGoWhereAnEchoContradictsIt) {
  SimulatedDrive drive(along_a_street());
  LocalizerConfig of_all = small_map_config();
  of_all.echoes.expects_all_ranges = true;
  Localizer asked(small_map_config());
  Localizer told(of_all);
  constexpr std::uint32_t kScans = 40;
  constexpr std::size_t kBeam = 120;
  for (std::uint32_t number = 0; number < kScans; ++number) {
    sensing::LaserScan scan = drive.scan(number);
    if (number + 1 == kScans) scan.range_m[kBeam] *= 0.5F;
    for (Localizer* each : {&asked, &told}) each->add_odometry(drive.odometry(number));
    const auto of_asked = asked.localize(scan);
    const auto of_told = told.localize(scan);
    asked.integrate(all_stationary(*of_asked));
    told.integrate(all_stationary(*of_told));
    if (number + 1 < kScans) continue;
    ASSERT_EQ(of_asked->beams[kBeam].end_cell, flow::EndCell::kFree);
    for (std::size_t i = 0; i < of_told->beams.size(); ++i) {
      const std::size_t first = i < flow::kExpectedAside ? 0 : i - flow::kExpectedAside;
      const std::size_t end = std::min(i + flow::kExpectedAside + 1, of_told->beams.size());
      const bool is_near_a_contradiction = std::any_of(
          of_told->beams.begin() + first, of_told->beams.begin() + end,
          [](const flow::LocalizedBeam& beam) { return beam.end_cell == flow::EndCell::kFree; });
      EXPECT_GT(of_told->beams[i].expected_range_m, 0.0F) << i;
      EXPECT_EQ(of_asked->beams[i].expected_range_m,
                is_near_a_contradiction ? of_told->beams[i].expected_range_m : 0.0F)
          << i;
    }
  }
}

TEST(Localizer, MakesTheSameInTheMemoryOfAnotherScan) {
  SimulatedDrive drive(along_a_street());
  Localizer localizer(small_map_config());
  Localizer thrifty(small_map_config());
  flow::LocalizedScan done_with;
  for (std::uint32_t scan = 0; scan < 100; ++scan) {  // more than are kept for restoring
    for (Localizer* each : {&localizer, &thrifty}) each->add_odometry(drive.odometry(scan));
    auto expected = localizer.localize(drive.scan(scan));
    auto localized = thrifty.localize(drive.scan(scan), std::move(done_with));
    localizer.integrate(all_stationary(*expected));
    thrifty.integrate(all_stationary(*localized));
    ASSERT_THAT(localized->odom_from_base.pose, PoseNear(expected->odom_from_base.pose, 0.0));
    for (std::size_t i = 0; i < expected->beams.size(); ++i) {
      ASSERT_EQ(localized->beams[i].end_cell, expected->beams[i].end_cell);
      ASSERT_EQ(localized->beams[i].expected_range_m, expected->beams[i].expected_range_m);
      ASSERT_EQ(localized->beams[i].free_evidence, expected->beams[i].free_evidence);
    }
    done_with = std::move(*localized);
  }
}

TEST(Localizer, SaysHowFastItGoes) {
  SimulatedDrive drive(along_a_street());
  Localizer localizer(small_map_config());
  std::optional<flow::LocalizedScan> localized;
  for (std::uint32_t scan = 0; scan < 60; ++scan) localized = drive_one(localizer, drive, scan);
  EXPECT_NEAR(localized->speed_mps, 8.0, 0.1);
  EXPECT_NEAR(localized->yaw_rate_radps, 0.0, 0.01);
}

TEST(Localizer, IsSurerOfItsWayWhereItStandsThanWhereItDrives) {
  DriveSetup setup = along_a_street();
  setup.world_from_base_at = [path = setup.world_from_base_at](double time_s) {
    return path(std::min(time_s, 5.0));
  };
  SimulatedDrive drive(setup);
  Localizer localizer(small_map_config());
  std::optional<flow::LocalizedScan> driving;
  for (std::uint32_t scan = 0; scan < 100; ++scan) driving = drive_one(localizer, drive, scan);
  std::optional<flow::LocalizedScan> standing;
  for (std::uint32_t scan = 100; scan < 200; ++scan) standing = drive_one(localizer, drive, scan);
  EXPECT_LT(9.0 * standing->odom_from_base.covariance(0, 0),
            driving->odom_from_base.covariance(0, 0));
  EXPECT_LT(standing->odom_from_base.covariance(1, 1), driving->odom_from_base.covariance(1, 1));
}

TEST(Localizer, GivesTheSameAnswerWhereverTheWorldLies) {
  const Pose2 there_from_here{70.3, -12.9, 2.2};
  DriveSetup setup = round_in_a_room();
  SimulatedDrive here(setup);
  const auto path_here = setup.world_from_base_at;
  setup.world = slammot::testing::moved(setup.world, there_from_here);
  setup.world_from_base_at = [=](double time_s) { return there_from_here * path_here(time_s); };
  SimulatedDrive there(setup);
  Localizer localizer_here(small_map_config());
  Localizer localizer_there(small_map_config());
  for (std::uint32_t scan = 0; scan < 60; ++scan) {
    const Pose2 pose_here = drive_one(localizer_here, here, scan)->odom_from_base.pose;
    EXPECT_THAT(drive_one(localizer_there, there, scan)->odom_from_base.pose,
                PoseNear(pose_here, 1e-3));
  }
}

TEST(Localizer, CarriesTheScanOnAndAddsOneBeamForEach) {
  SimulatedDrive drive(along_a_street());
  Localizer localizer(small_map_config());
  drive_one(localizer, drive, 0);
  const auto scan = drive.scan(1);
  const auto localized = drive_one(localizer, drive, 1);
  EXPECT_EQ(localized->stamp_ns, scan.stamp_ns);
  EXPECT_EQ(localized->sequence, 1U);
  EXPECT_EQ(localized->scanner_id, "front");
  EXPECT_EQ(localized->base_from_laser, scan.scanner.base_from_laser);
  ASSERT_EQ(localized->beams.size(), scan.range_m.size());
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    const bool has_echo = sensing::is_echo(scan.range_m[i], scan.scanner.max_range_m);
    EXPECT_EQ(localized->beams[i].range_m, has_echo ? scan.range_m[i] : 0.0F);
    EXPECT_EQ(localized->beams[i].end_cell == flow::EndCell::kNoEcho, !has_echo);
  }
}

TEST(Localizer, TakesScansOfTwoScannersAtTheSameTime) {
  SimulatedDrive drive(along_a_street());
  Localizer localizer(small_map_config());
  for (std::uint32_t number = 0; number < 60; ++number) {
    const auto front = drive_one(localizer, drive, number);
    sensing::LaserScan second = drive.scan(number);
    second.scanner.scanner_id = "second";
    const auto localized = localizer.localize(second);
    ASSERT_TRUE(localized);
    localizer.integrate(all_stationary(*localized));
    EXPECT_EQ(localized->speed_mps, front->speed_mps);
    EXPECT_THAT(localized->odom_from_base.pose, PoseNear(drive.odom_from_base(number), 0.1));
  }
  EXPECT_EQ(localizer.counters().scans.duplicate, 0U);
  EXPECT_EQ(localizer.counters().scans.localized, 120U);
}

/// A scanner that looks back, half a period after the one that looks ahead.
SimulatedDrive backwards_along_a_street() {
  DriveSetup setup = along_a_street();
  setup.scanner.scanner_id = "rear";
  setup.scanner.base_from_laser = {-2.15, 0.0, std::numbers::pi};
  setup.world_from_base_at = [ahead = setup.world_from_base_at, half_s = 0.5 * setup.scan_period_s](
                                 double time_s) { return ahead(time_s + half_s); };
  return SimulatedDrive(setup);
}

TEST(Localizer, GoesOnWithOneOfTwoScannersWhenTheOtherFallsSilent) {
  for (const bool rear_falls_silent : {true, false}) {
    SimulatedDrive front(along_a_street());
    const SimulatedDrive rear = backwards_along_a_street();
    Localizer localizer(small_map_config());
    for (std::uint32_t number = 0; number < 100; ++number) {
      const bool one_is_silent = number >= 50;
      if (number == 0) localizer.add_odometry(front.odometry(0));
      localizer.add_odometry(front.odometry(number + 1));  // the service waits for what reaches the
                                                           // rear scan
      if (!one_is_silent || rear_falls_silent) {
        const auto localized = localizer.localize(front.scan(number));
        ASSERT_TRUE(localized);
        localizer.integrate(all_stationary(*localized));
        EXPECT_THAT(localized->odom_from_base.pose, PoseNear(front.odom_from_base(number), 0.1));
      }
      if (one_is_silent && rear_falls_silent) continue;
      sensing::LaserScan scan = rear.scan(number);
      scan.stamp_ns += std::llround(0.5e9 * (front.time_s(1) - front.time_s(0)));
      const auto localized = localizer.localize(scan);
      ASSERT_TRUE(localized);
      localizer.integrate(all_stationary(*localized));
    }
    EXPECT_LE(localizer.counters().matches.lost, 1U);  // the first scan to the rear sees nothing
                                                       // that is in the map yet
    EXPECT_EQ(localizer.counters().scans.out_of_order, 0U);
  }
}

TEST(Localizer, DropsAndCountsDuplicatesAndScansOutOfOrder) {
  SimulatedDrive drive(round_in_a_room());
  Localizer disturbed(small_map_config());
  Localizer undisturbed(small_map_config());
  for (std::uint32_t scan = 0; scan < 40; ++scan) {
    const auto expected = drive_one(undisturbed, drive, scan);
    disturbed.add_odometry(drive.odometry(scan));
    const auto localized = disturbed.localize(drive.scan(scan));
    ASSERT_TRUE(localized);
    EXPECT_EQ(localized->odom_from_base.pose, expected->odom_from_base.pose);
    EXPECT_FALSE(disturbed.localize(drive.scan(scan)));
    if (scan > 0) EXPECT_FALSE(disturbed.localize(drive.scan(scan - 1)));
    disturbed.integrate(all_stationary(*localized));
    disturbed.integrate(all_stationary(*localized));  // labels may come twice as well
  }
  EXPECT_EQ(disturbed.counters().scans.localized, 40U);
  EXPECT_EQ(disturbed.counters().scans.duplicate, 40U);
  EXPECT_EQ(disturbed.counters().scans.out_of_order, 39U);
}

TEST(Localizer, IsNotMadeLateByAScanStampedFarInTheFuture) {
  SimulatedDrive drive(round_in_a_room());
  Localizer disturbed(small_map_config());
  Localizer undisturbed(small_map_config());
  for (std::uint32_t scan = 0; scan < 40; ++scan) {
    if (scan == 20) {
      sensing::LaserScan ahead = drive.scan(scan);
      ahead.stamp_ns += 4'000'000'000'000;
      sensing::Odometry odometry = drive.odometry(scan);
      odometry.stamp_ns = ahead.stamp_ns;
      disturbed.add_odometry(odometry);
      EXPECT_FALSE(disturbed.localize(ahead));
      EXPECT_FALSE(disturbed.has_odometry_for(ahead.stamp_ns));
    }
    const auto expected = drive_one(undisturbed, drive, scan);
    const auto localized = drive_one(disturbed, drive, scan);
    ASSERT_TRUE(localized) << scan;
    EXPECT_EQ(localized->odom_from_base.pose, expected->odom_from_base.pose);
  }
  EXPECT_EQ(disturbed.counters().scans.far_ahead, 1U);
  EXPECT_EQ(disturbed.counters().scans.out_of_order, 0U);
}

TEST(Localizer, WorksWithoutAnyOdometry) {
  DriveSetup setup = round_in_a_room();
  SimulatedDrive drive(setup);
  Localizer localizer(small_map_config());
  const DriveErrors errors = drive_through(localizer, drive, 0, 150, false);
  EXPECT_LT(errors.worst_m, 0.05);
  EXPECT_LT(errors.worst_rad, 0.01);
  EXPECT_EQ(localizer.counters().odometry.missing, 149U);
}

TEST(Localizer, WorksWithoutAnyOdometryWhenTheLogBeginsInFullDrive) {
  DriveSetup setup = along_a_street();
  setup.scan_period_s = 1.0 / 37.5;
  setup.beams = 361;
  setup.scanner.beam_step_rad *= 0.5;
  SimulatedDrive drive(setup);
  Localizer localizer(small_map_config());
  const DriveErrors errors = drive_through(localizer, drive, 0, 200, false);
  EXPECT_LT(errors.worst_m, 0.4);  // the sweep's motion is not known at first, and shears the first
                                   // walls
  EXPECT_LT(errors.worst_rad, 0.01);
}

/// The same scans, farther apart in time.
DriveSetup with_rare_scans(DriveSetup setup, double period_s) {
  setup.world_from_base_at = [path = setup.world_from_base_at,
                              slower = setup.scan_period_s / period_s](double time_s) {
    return path(slower * time_s);
  };
  setup.scan_period_s = period_s;
  return setup;
}

/// From scan 50 up to this one, odometry is elsewhere by the jump.
void expect_not_to_follow(const Pose2& jump, SimulatedDrive drive, std::uint32_t end,
                          double within_m) {
  Localizer localizer(small_map_config());
  drive_through(localizer, drive, 0, 50);
  for (std::uint32_t scan = 50; scan < end; ++scan) {
    sensing::Odometry odometry = drive.odometry(scan);
    odometry.wheel_from_base = jump * odometry.wheel_from_base;
    localizer.add_odometry(odometry);
    const auto localized = localizer.localize(drive.scan(scan));
    localizer.integrate(all_stationary(*localized));
    EXPECT_THAT(localized->odom_from_base.pose, PoseNear(drive.odom_from_base(scan), within_m));
  }
  EXPECT_EQ(localizer.counters().odometry.jumps, 1U);
}

TEST(Localizer, GoesOnAtConstantVelocityWhenOdometryJumps) {
  expect_not_to_follow({400.0, -30.0, 1.0}, SimulatedDrive(round_in_a_room()), 100, 0.03);
}

/// A robot that logs a scan every two seconds, 0.2 m apart, could have driven 20 m meanwhile.
TEST(Localizer, IsNotMovedByAJumpOfOdometryThatIsFarForItsUsualSteps) {
  expect_not_to_follow({14.0, -3.0, 2.0}, SimulatedDrive(with_rare_scans(round_in_a_room(), 2.0)),
                       70, 0.05);
}

TEST(Localizer, IsNotMovedByJumpsOfOdometryOfAnySizeAlsoSeveralInARow) {
  for (const Pose2& jump : {Pose2{0.3, 0.0, 0.0}, Pose2{-0.5, 0.8, 0.0}, Pose2{2.0, 0.0, 0.0},
                            Pose2{0.0, 0.0, 0.3}, Pose2{0.0, 0.0, -2.0}, Pose2{4.0, -3.0, 1.5}}) {
    SimulatedDrive drive(round_in_a_room());
    Localizer localizer(small_map_config());
    drive_through(localizer, drive, 0, 50);
    Pose2 sum;
    for (std::uint32_t scan = 50; scan < 100; ++scan) {
      sensing::Odometry odometry = drive.odometry(scan);
      if (scan == 60 || scan == 80 || scan == 82 || scan == 84)
        sum = sum * (odometry.wheel_from_base * jump * inverse(odometry.wheel_from_base));
      odometry.wheel_from_base = sum * odometry.wheel_from_base;
      localizer.add_odometry(odometry);
      const auto localized = localizer.localize(drive.scan(scan));
      localizer.integrate(all_stationary(*localized));
      EXPECT_THAT(localized->odom_from_base.pose, PoseNear(drive.odom_from_base(scan), 0.04))
          << scan << " after jumps of " << jump.x_m << " " << jump.y_m << " " << jump.heading_rad;
    }
    EXPECT_EQ(localizer.counters().odometry.jumps, 4U);
  }
}

TEST(Localizer, BelievesWheelsThatKeepSayingThatTheVelocityHasChanged) {
  DriveSetup setup = round_in_a_room();
  const auto path = arc({-6.0, -3.0, 0.0}, 4.0, 0.0);
  setup.world_from_base_at = [=](double time_s) { return path(std::min(time_s, 2.0)); };  // as if
                                                                                          // against
                                                                                          // a wall
  SimulatedDrive drive(setup);
  Localizer localizer(small_map_config());
  EXPECT_LT(drive_through(localizer, drive, 0, 60).worst_m, 0.05);
  EXPECT_EQ(localizer.counters().odometry.jumps, 1U);
}

TEST(Localizer, TakesNoOdometryWhereItIsToldNotTo) {
  LocalizerConfig config = small_map_config();
  config.odometry.use_odometry = false;
  SimulatedDrive drive(round_in_a_room());
  Localizer localizer(config);
  drive_through(localizer, drive, 0, 20);
  EXPECT_EQ(localizer.counters().odometry.missing, 19U);
}

/// Through a hall at 3 m/s, with a bend that begins and ends at once.
DriveSetup through_a_hall() {
  DriveSetup setup{
      .world = slammot::testing::joined(slammot::testing::box({20.0, 0.0, 0.0}, 110.0, 70.0),
                                        slammot::testing::box({60.0, 25.0, 0.4}, 8.0, 5.0))};
  setup.scan_period_s = 0.027;
  setup.beams = 361;
  setup.scanner.beam_step_rad = std::numbers::pi / 360.0;
  setup.scanner.max_range_m = 80.0;
  setup.scanner.base_from_laser = {2.15, 0.0, 0.0};
  setup.scanner.sweep_s = 0.013;
  setup.world_from_base_at = [](double time_s) {
    constexpr double kTurns_s = 5.0, kHasTurned_s = 7.0, kYawRate_radps = 1.0;
    const double speed_mps = std::min(3.0, 1.5 * time_s);
    const double start_m = time_s < 2.0 ? 0.5 * speed_mps * time_s : 3.0 * (time_s - 1.0);
    if (time_s < kTurns_s) return Pose2{start_m, 0.0, 0.0};
    const double turning_s = std::min(time_s, kHasTurned_s) - kTurns_s;
    const Pose2 turned = Pose2{12.0, 0.0, 0.0} * arc({}, 3.0, kYawRate_radps)(turning_s);
    return turned * Pose2{3.0 * std::max(0.0, time_s - kHasTurned_s), 0.0, 0.0};
  };
  return setup;
}

TEST(Localizer, FollowsABendWithoutOdometryThatBeginsAndEndsAtOnce) {
  LocalizerConfig config = small_map_config();
  config.odometry.use_odometry = false;
  SimulatedDrive drive(through_a_hall());
  Localizer localizer(config);
  EXPECT_LT(drive_through(localizer, drive, 0, 300).worst_rad, 0.01);
  EXPECT_EQ(localizer.counters().matches.lost, 0U);
}

/// A vehicle that stops behind a car that stands and, seconds later, drives off before it does.
class BehindACarThatDrivesOff : public ::testing::Test {
 protected:
  static constexpr double kStops_s = 4.0;
  static constexpr double kCarStarts_s = 5.0;
  static constexpr double kStarts_s = 6.0;
  static constexpr double kAcceleration_mps2 = 2.0;

  static double started_m(double for_s) {
    return 0.5 * kAcceleration_mps2 * std::pow(std::max(0.0, for_s), 2);
  }

  static DriveSetup setup() {
    DriveSetup setup = along_a_street();
    setup.scan_period_s = 0.027;
    setup.beams = 361;
    setup.scanner.beam_step_rad = std::numbers::pi / 360.0;
    setup.world_from_base_at = [](double time_s) {
      const double to_stop_s = std::max(0.0, kStops_s - time_s);
      return Pose2{
          40.0 - 0.5 * kAcceleration_mps2 * to_stop_s * to_stop_s + started_m(time_s - kStarts_s),
          0.0, 0.0};
    };
    return setup;
  }

  /// The worst error of a pose until 2 s after the vehicle has started; to whoever labels the
  /// points everything stands.
  double worst_m(const LocalizerConfig& config) {
    SimulatedDrive drive(setup());
    const World street = drive.setup().world;
    Localizer localizer(config);
    double worst_m = 0.0;
    for (std::uint32_t scan = 0; drive.time_s(scan) < kStarts_s + 2.0; ++scan) {
      const double car_at_m =
          40.0 + 2.15 + 5.0 + 2.25 + started_m(drive.time_s(scan) - kCarStarts_s);
      drive.setup().world =
          slammot::testing::joined(street, slammot::testing::box({car_at_m, 0.0, 0.0}, 4.5, 1.8));
      worst_m = std::max(worst_m, drive_through(localizer, drive, scan, scan + 1, false).worst_m);
    }
    return worst_m;
  }
};

TEST_F(BehindACarThatDrivesOff, StandsWithoutOdometryWhereAllElseStands) {
  LocalizerConfig config = small_map_config();
  config.odometry.use_odometry = false;
  EXPECT_LT(worst_m(config), 0.1);
}

TEST_F(BehindACarThatDrivesOff, WouldFollowItIfEachPointCountedForItself) {
  LocalizerConfig config = small_map_config();
  config.odometry.use_odometry = false;
  config.trust.body_sigma_without_wheels_m = 0.0;
  EXPECT_GT(worst_m(config), 1.0);
}

TEST(Localizer, BridgesTwoSecondsWithoutScans) {
  for (const bool with_odometry : {true, false}) {
    SimulatedDrive drive(round_in_a_room());
    Localizer localizer(small_map_config());
    drive_through(localizer, drive, 0, 50, with_odometry);
    const DriveErrors errors = drive_through(localizer, drive, 71, 120, with_odometry);
    EXPECT_LT(errors.worst_m, 0.05) << with_odometry;
    EXPECT_EQ(localizer.counters().odometry.gaps, 1U);
  }
}

TEST(Localizer, FollowsTheWheelsWhenTheScannerSeesNextToNothing) {
  SimulatedDrive drive(round_in_a_room());
  Localizer localizer(small_map_config());
  drive_through(localizer, drive, 0, 50);
  for (std::uint32_t scan = 50; scan < 60; ++scan) {
    localizer.add_odometry(drive.odometry(scan));
    auto blinded = drive.scan(scan);
    const std::size_t valid_beams = scan % 2 == 0 ? 3 : 0;
    for (std::size_t i = valid_beams; i < blinded.range_m.size(); ++i)
      blinded.range_m[i] = static_cast<float>(blinded.scanner.max_range_m);
    const auto localized = localizer.localize(blinded);
    ASSERT_TRUE(localized);
    EXPECT_TRUE(localized->beams.empty()) << "says nothing of objects or free space";
    localizer.integrate(all_stationary(*localized));
    EXPECT_THAT(localized->odom_from_base.pose, PoseNear(drive.odom_from_base(scan), 0.03));
  }
  EXPECT_EQ(localizer.counters().scans.blank, 10U);
  EXPECT_LT(drive_through(localizer, drive, 60, 90).worst_m, 0.03);
}

TEST(Localizer, FollowsTheWheelsWhileTheScannerHangs) {
  for (const double period_s : {0.1, 1.0}) {
    SimulatedDrive drive(with_rare_scans(round_in_a_room(), period_s));
    Localizer localizer(small_map_config());
    drive_through(localizer, drive, 0, 50);
    const std::vector<float> last = drive.scan(49).range_m;
    for (std::uint32_t scan = 50; scan < 60; ++scan) {
      localizer.add_odometry(drive.odometry(scan));
      auto frozen = drive.scan(scan);
      frozen.range_m = last;
      const auto localized = localizer.localize(frozen);
      ASSERT_TRUE(localized);
      EXPECT_TRUE(localized->beams.empty()) << "says nothing of objects or free space";
      localizer.integrate(all_stationary(*localized));
      EXPECT_THAT(localized->odom_from_base.pose, PoseNear(drive.odom_from_base(scan), 0.03));
    }
    EXPECT_EQ(localizer.counters().scans.frozen, 10U) << period_s;
    EXPECT_EQ(localizer.counters().scans.blank, 0U) << period_s;
    EXPECT_LT(drive_through(localizer, drive, 60, 90).worst_m, 0.03) << period_s;
  }
}

TEST(Localizer, TakesScansOfNonsense) {
  SimulatedDrive drive(round_in_a_room());
  Localizer localizer(small_map_config());
  drive_through(localizer, drive, 0, 20);
  auto scan = drive.scan(20);
  const float strange[] = {std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(), -1.0F, 0.0F, 1e30F};
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) scan.range_m[i] = strange[i % 5];
  EXPECT_TRUE(localizer.localize(scan));
  scan = drive.scan(21);
  scan.range_m.clear();
  EXPECT_FALSE(localizer.localize(scan));
  scan = drive.scan(22);
  EXPECT_EQ(localizer.counters().scans.blank, 2u);
  EXPECT_LT(drive_through(localizer, drive, 23, 40).worst_m, 0.05);
}

TEST(Localizer, PredictsThePoseOfABlankScan) {
  SimulatedDrive drive(round_in_a_room());
  Localizer localizer(small_map_config());
  Localizer without(small_map_config());
  for (std::uint32_t scan = 0; scan < 22; ++scan) {
    const sensing::Odometry odometry = drive.odometry(scan);
    for (Localizer* each : {&localizer, &without}) each->add_odometry(odometry);
    if (scan == 20) continue;
    for (Localizer* each : {&localizer, &without}) {
      if (scan == 21 && each == &localizer) {
        auto blank = drive.scan(20);
        std::ranges::fill(blank.range_m, std::numeric_limits<float>::quiet_NaN());
        const auto predicted = localizer.localize(blank);
        ASSERT_TRUE(predicted);
        EXPECT_EQ(predicted->stamp_ns, blank.stamp_ns);
        EXPECT_TRUE(predicted->beams.empty());
        EXPECT_LT(testing::distance_m(predicted->odom_from_base.pose, drive.odom_from_base(20)),
                  0.05);
        EXPECT_FALSE(localizer.localize(blank)) << "a second one with this stamp";
        EXPECT_TRUE(localizer.awaits_labels());
        localizer.integrate(testing::all_stationary(*predicted));
        EXPECT_FALSE(localizer.awaits_labels());
        EXPECT_EQ(localizer.counters().map.withheld_scans, 0u);
      }
      each->integrate(testing::all_stationary(*each->localize(drive.scan(scan))));
    }
  }
  EXPECT_EQ(localizer.counters().scans.blank, 2u);
  EXPECT_EQ(localizer.checkpoint().size(), without.checkpoint().size());
  const auto after = drive_one(localizer, drive, 22);
  without.add_odometry(drive.odometry(22));
  const auto after_without = without.localize(drive.scan(22));
  ASSERT_TRUE(after && after_without);
  EXPECT_EQ(after->odom_from_base.pose, after_without->odom_from_base.pose);
}

TEST(Localizer, LearnsNothingAboutTheWheelsWhereItDidNotMatch) {
  SimulatedDrive drive(along_a_street());
  Localizer localizer(small_map_config());
  drive_through(localizer, drive, 0, 5);
  const auto before = localizer.calibration();
  for (std::uint32_t scan = 5; scan < 40; ++scan) {
    localizer.add_odometry(drive.odometry(scan));
    auto blinded = drive.scan(scan);
    std::fill(blinded.range_m.begin(), blinded.range_m.end(), 50.0F);
    localizer.localize(blinded);
  }
  EXPECT_EQ(localizer.calibration(), before);
}

TEST(Localizer, HasOdometryForWhatTheWheelsHaveReached) {
  Localizer localizer(small_map_config());
  EXPECT_FALSE(localizer.has_odometry_for(5));
  localizer.add_odometry({5, {}});
  EXPECT_TRUE(localizer.has_odometry_for(5));
  EXPECT_FALSE(localizer.has_odometry_for(6));
}

/// Something that crosses the room while the robot stands, once the room is known.
class WithAMover : public ::testing::Test {
 protected:
  WithAMover()
      : drive_({.world = slammot::testing::room(),
                .world_from_base_at = arc({-3.0, 0.0, 0.0}, 0.0, 0.0)}) {
    drive_through(localizer_, drive_, 0, 20);
  }

  static Pose2 world_from_mover(std::uint32_t scan) {
    return {1.0, -3.5 + 0.15 * (scan - 20), 0.0};
  }

  /// The scan, and which of its beams met the mover.
  std::pair<sensing::LaserScan, std::vector<bool>> scan_with_mover(std::uint32_t number) {
    const auto without = drive_.scan(number);
    DriveSetup setup = drive_.setup();
    setup.world = joined(setup.world, slammot::testing::box(world_from_mover(number), 0.6, 0.6));
    const auto with = SimulatedDrive(setup).scan(number);
    std::vector<bool> on_mover;
    for (std::size_t i = 0; i < with.range_m.size(); ++i)
      on_mover.push_back(with.range_m[i] < without.range_m[i] - 0.2F);
    return {with, on_mover};
  }

  flow::ScanLabels labels(const flow::LocalizedScan& scan, const std::vector<bool>& on_mover) {
    flow::ScanLabels labels = all_stationary(scan);
    for (std::size_t i = 0; i < on_mover.size(); ++i) {
      if (on_mover[i]) labels.labels[i] = PointLabel::kMoving;
    }
    return labels;
  }

  /// Surfels and occupied cells where only the mover ever was.
  int traces_in_the_map() const { return traces_in_the_map(localizer_); }
  int traces_in_the_map(const Localizer& localizer) const {
    int traces = 0;
    const Pose2 odom_from_world =
        inverse(drive_.odom_from_base(0)) * inverse(Pose2{-3.0, 0.0, 0.0});
    for (double y_m = -3.5; y_m < 1.0; y_m += 0.1) {
      for (double x_m = 0.6; x_m < 1.4; x_m += 0.1) {
        const Vector2 at_m = odom_from_world * Vector2(x_m, y_m);
        const auto surfel = localizer.local_map().surfels().nearest(at_m, 1);
        const auto& evidence = localizer.local_map().evidence();
        traces += (surfel && (surfel->mean_m - at_m).norm() < 0.2) ||
                  evidence.so_steps(evidence.window().cell_at(at_m.x(), at_m.y())) > 0;
      }
    }
    return traces;
  }

  double moving_evidence() const {
    double sum = 0.0;
    for (const std::uint8_t one : localizer_.local_map().evidence().mo_cells()) sum += one;
    return sum;
  }

  SimulatedDrive drive_;
  Localizer localizer_{small_map_config()};
};

TEST_F(WithAMover, LabelsDecideWhichMapAPointGoesTo) {
  for (std::uint32_t scan = 20; scan < 45; ++scan) {
    const auto [range, on_mover] = scan_with_mover(scan);
    localizer_.integrate(labels(*localizer_.localize(range), on_mover));
  }
  EXPECT_EQ(traces_in_the_map(), 0);
  EXPECT_GT(moving_evidence(), 1000.0);
  EXPECT_EQ(localizer_.counters().map.fallback_integrations, 0U);
}

TEST_F(WithAMover, LabelledStationaryItLeavesTraces) {
  for (std::uint32_t scan = 20; scan < 24; ++scan)
    localizer_.integrate(all_stationary(*localizer_.localize(scan_with_mover(scan).first)));
  EXPECT_GT(traces_in_the_map(), 0);
}

TEST_F(WithAMover, StaysOutOfTheMapWhenLabelsNeverCome) {
  for (std::uint32_t scan = 20; scan < 45; ++scan)
    EXPECT_TRUE(localizer_.localize(scan_with_mover(scan).first));
  localizer_.finish();
  EXPECT_EQ(traces_in_the_map(), 0);
  EXPECT_EQ(moving_evidence(), 0.0);
  EXPECT_EQ(localizer_.counters().map.fallback_integrations, 25U);
}

TEST_F(WithAMover, GoesToTheMovingMapByDetectionsLabelsWhenTrackingsNeverCome) {
  for (std::uint32_t scan = 20; scan < 45; ++scan) {
    const auto [range, on_mover] = scan_with_mover(scan);
    const auto localized = localizer_.localize(range);
    flow::SegmentedScan segmented;
    segmented.sequence = scan;
    segmented.scanner_id = localized->scanner_id;
    segmented.labels = labels(*localized, on_mover).labels;
    localizer_.note(segmented);
  }
  localizer_.finish();
  EXPECT_EQ(traces_in_the_map(), 0);
  EXPECT_GT(moving_evidence(), 1000.0);
}

TEST_F(WithAMover, TakesLabelsThatComeThreeScansLate) {
  std::vector<flow::ScanLabels> late;
  for (std::uint32_t scan = 20; scan < 45; ++scan) {
    const auto [range, on_mover] = scan_with_mover(scan);
    late.push_back(labels(*localizer_.localize(range), on_mover));
    if (late.size() > 3) localizer_.integrate(late[late.size() - 4]);
  }
  for (const auto& one : late) localizer_.integrate(one);
  EXPECT_EQ(traces_in_the_map(), 0);
}

TEST_F(WithAMover, IntegratesAScanWhoseLabelsWereLostWhenTheNextOnesCome) {
  for (std::uint32_t scan = 20; scan < 40; ++scan) {
    const auto [range, on_mover] = scan_with_mover(scan);
    const auto localized = localizer_.localize(range);
    if (scan % 2 == 1) localizer_.integrate(labels(*localized, on_mover));
  }
  EXPECT_EQ(localizer_.counters().map.fallback_integrations, 10U);
  EXPECT_EQ(traces_in_the_map(), 0);
}

TEST_F(WithAMover, ComesBackIntoTheMapWhenTrackingFindsItStands) {
  const auto [range, on_mover] = scan_with_mover(20);
  localizer_.integrate(labels(*localizer_.localize(range), on_mover));
  EXPECT_EQ(traces_in_the_map(), 0);
  flow::RestoredPoints restored{20, {}};
  for (std::size_t i = 0; i < on_mover.size(); ++i) {
    if (on_mover[i]) restored.beams.push_back(static_cast<std::uint16_t>(i));
  }
  ASSERT_GT(restored.beams.size(), 2U);
  auto later = labels(*localizer_.localize(scan_with_mover(21).first), scan_with_mover(21).second);
  later.restored = {restored, {999, {1, 2, 3}}, {20, {60000}}};  // also a scan and a beam that
                                                                 // never were
  localizer_.integrate(later);
  EXPECT_GT(traces_in_the_map(), 0);
  EXPECT_EQ(localizer_.counters().map.restored_points, restored.beams.size());
  const std::vector<std::int8_t> once = localizer_.local_map().evidence().lasting_cells();
  auto again = labels(*localizer_.localize(scan_with_mover(22).first), scan_with_mover(22).second);
  again.labels.clear();  // of no scan
  again.restored = {restored};
  localizer_.integrate(again);
  EXPECT_EQ(localizer_.local_map().evidence().lasting_cells(), once);
}

TEST_F(WithAMover, IsNotGivenBackFromFartherThanIsMapped) {
  LocalizerConfig config = small_map_config();
  config.echoes.map_range_m = 1.0;
  Localizer localizer(config);
  const auto [range, on_mover] = scan_with_mover(20);
  localizer.integrate(labels(*localizer.localize(range), on_mover));
  auto later = labels(*localizer.localize(scan_with_mover(21).first), scan_with_mover(21).second);
  later.restored = {{20, {}}};
  for (std::size_t i = 0; i < on_mover.size(); ++i) {
    if (on_mover[i]) later.restored.front().beams.push_back(static_cast<std::uint16_t>(i));
  }
  localizer.integrate(later);
  EXPECT_EQ(localizer.counters().map.restored_points, 0U);
}

TEST_F(WithAMover, IsTakenOutOfTheMapWhereItDrives) {
  const auto walls_under_one = [&](const std::function<void(flow::TrackedObject&)>& change) {
    Localizer localizer(small_map_config());
    SimulatedDrive drive(drive_.setup());
    drive_through(localizer, drive, 0, 20);
    localizer.add_odometry(drive.odometry(20));
    const auto localized = *localizer.localize(drive.scan(20));
    flow::TrackedObject object;
    object.confirmed = true;
    object.first_seen_ns = localized.stamp_ns - 600'000'000;
    object.last_seen_ns = localized.stamp_ns;
    object.velocity_in_odom_mps = {0.0, 3.0};
    object.covariance = 0.04 * Eigen::Matrix4d::Identity();
    object.length_m = object.width_m = 100.0;  // all of the room
    change(object);
    localizer.expect({localized.stamp_ns, localized.sequence, {}, {}, {object}, {}, {}});
    localizer.integrate(all_stationary(localized));
    const auto& evidence = localizer.local_map().evidence();
    double sum = 0.0;
    for (const std::int8_t steps : evidence.so_cells()) sum += std::max<int>(0, steps);
    return sum;
  };
  const double under_one_at_rest =
      walls_under_one([](flow::TrackedObject& object) { object.velocity_in_odom_mps.setZero(); });
  EXPECT_LT(walls_under_one([](flow::TrackedObject&) {}), under_one_at_rest);
  EXPECT_EQ(walls_under_one([](flow::TrackedObject& object) { object.confirmed = false; }),
            under_one_at_rest);
  EXPECT_EQ(walls_under_one([](flow::TrackedObject& object) { object.covariance *= 100.0; }),
            under_one_at_rest);
  EXPECT_EQ(walls_under_one([](flow::TrackedObject& object) { object.last_seen_ns -= 1; }),
            under_one_at_rest);
  EXPECT_EQ(
      walls_under_one([](flow::TrackedObject& object) { object.first_seen_ns += 200'000'000; }),
      under_one_at_rest);
  EXPECT_EQ(walls_under_one([](flow::TrackedObject& object) { object.length_m = 0.5; }),
            under_one_at_rest)
      << "who walks";
}

TEST_F(WithAMover, IsLeftOutOfTheMatchWhereATrackExpectsIt) {
  // A wall of a thing right before the scanner, that moves sideways with all its points and would
  // pull the pose along.
  DriveSetup setup = drive_.setup();
  setup.world = joined(setup.world, slammot::testing::box({0.0, 0.0, 0.0}, 0.5, 8.0));
  LocalizerConfig config = small_map_config();
  config.trust.ambiguous.weak_share = 0.0;  // samples disagree about such a scan and keep it from
                                            // pulling anyway,
  config.odometry.use_odometry = false;     // and so do wheels, most of all where they stand
  const auto pulled_m = [&](bool with_track) {
    SimulatedDrive blocked(setup);
    Localizer localizer(config);
    drive_through(localizer, blocked, 0, 20);
    flow::TrackedObjects objects;
    objects.stamp_ns = blocked.scan(20).stamp_ns;
    flow::TrackedObject object;
    object.confirmed = true;
    object.position_in_odom_m = {3.0, 0.0};
    object.length_m = 1.2;
    object.width_m = 9.0;
    objects.objects = {object};
    if (with_track) localizer.expect(objects);
    DriveSetup moved_setup = drive_.setup();
    moved_setup.world =
        joined(moved_setup.world, slammot::testing::box({0.12, 0.0, 0.0}, 0.5, 8.0));
    SimulatedDrive later(moved_setup);
    return slammot::testing::distance_m(localizer.localize(later.scan(20))->odom_from_base.pose,
                                        later.odom_from_base(20));
  };
  EXPECT_LT(pulled_m(true), 0.01);
  EXPECT_GT(pulled_m(false), 2.0 * pulled_m(true));
}

TEST_F(WithAMover, MapsItAsIfItStoodWhenToldTo) {
  LocalizerConfig config = small_map_config();
  config.echoes.leave_out_moving = false;
  Localizer believes_all(config);
  drive_through(believes_all, drive_, 0, 20);
  for (Localizer* localizer : {&localizer_, &believes_all}) {
    const auto [scan, on_mover] = scan_with_mover(20);
    localizer->add_odometry(drive_.odometry(20));
    localizer->integrate(labels(*localizer->localize(scan), on_mover));
  }
  EXPECT_EQ(traces_in_the_map(localizer_), 0);
  EXPECT_GT(traces_in_the_map(believes_all), 0);
}

TEST_F(WithAMover, IsNoLongerExpectedWhenTrackingHasFallenSilent) {
  flow::TrackedObjects objects;
  flow::TrackedObject everything;
  everything.confirmed = true;
  everything.length_m = everything.width_m = 100.0;
  objects.stamp_ns = drive_.scan(19).stamp_ns;
  objects.objects = {everything};
  localizer_.expect(objects);
  drive_through(localizer_, drive_, 20, 25);
  const auto unmatched = localizer_.counters().matches.too_few_echoes;
  EXPECT_GT(unmatched, 0U);
  drive_through(localizer_, drive_, 50, 60);
  EXPECT_EQ(localizer_.counters().matches.too_few_echoes, unmatched);
}

/// A street with a new map every 20 m.
class OverSeveralSubmaps : public ::testing::Test {
 protected:
  static LocalizerConfig config() {
    LocalizerConfig config = small_map_config();
    config.map.new_map_after_m = 20.0;
    return config;
  }

  std::vector<flow::Submap> submaps_of_drive(Localizer& localizer) {
    SimulatedDrive drive(along_a_street());
    std::vector<flow::Submap> submaps;
    const auto take = [&] {
      while (auto submap = localizer.take_finished_submap()) submaps.push_back(std::move(*submap));
    };
    for (std::uint32_t scan = 0; scan < 200; ++scan) {
      scans_.push_back(*drive_one(localizer, drive, scan));
      take();
    }
    localizer.finish();
    take();
    return submaps;
  }

  std::vector<flow::LocalizedScan> scans_;
};

TEST_F(OverSeveralSubmaps, ThePoseNeverJumpsWhereTheNextOneBegins) {
  Localizer localizer(config());
  submaps_of_drive(localizer);
  int handovers = 0;
  for (std::size_t i = 1; i < scans_.size(); ++i) {
    const Pose2 step = inverse(scans_[i - 1].odom_from_base.pose) * scans_[i].odom_from_base.pose;
    EXPECT_NEAR(step.x_m, 0.4, 0.05);
    EXPECT_NEAR(step.y_m, 0.0, 0.05);
    handovers += scans_[i].submap_id != scans_[i - 1].submap_id;
  }
  EXPECT_GE(handovers, 3);
}

TEST_F(OverSeveralSubmaps, EachBeginsWhereTheOneBeforeEndsAndIsTiedToIt) {
  Localizer localizer(config());
  const auto submaps = submaps_of_drive(localizer);
  ASSERT_GE(submaps.size(), 4U);
  EXPECT_EQ(localizer.counters().map.submaps, submaps.size());
  EXPECT_EQ(submaps[0].previous_from_submap.pose, Pose2{});
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    EXPECT_EQ(submaps[i].submap_id.value, i);
    EXPECT_LE(submaps[i].first_stamp_ns, submaps[i].last_stamp_ns);
    EXPECT_EQ(submaps[i].so_log_odds.size(), std::size_t{submaps[i].columns} * submaps[i].rows);
    if (i == 0) continue;
    EXPECT_GT(submaps[i].first_stamp_ns, submaps[i - 1].last_stamp_ns);
    EXPECT_THAT(submaps[i - 1].odom_from_submap * submaps[i].previous_from_submap.pose,
                PoseNear(submaps[i].odom_from_submap, 1e-9));
  }
}

TEST_F(OverSeveralSubmaps, EveryScanSaysItsPoseInTheSubmapThatItNames) {
  Localizer localizer(config());
  const auto submaps = submaps_of_drive(localizer);
  ASSERT_GT(submaps.size(), 1U);
  ASSERT_FALSE(scans_.empty());
  for (const flow::LocalizedScan& scan : scans_) {
    const Pose2& odom_from_submap = submaps.at(scan.submap_id.value).odom_from_submap;
    EXPECT_THAT(odom_from_submap * scan.submap_from_base, PoseNear(scan.odom_from_base.pose, 1e-9));
  }
}

TEST_F(OverSeveralSubmaps, TheUncertaintyOfATieGrowsWithTheWayOfThatTieOnly) {
  Localizer localizer(config());
  const auto submaps = submaps_of_drive(localizer);
  ASSERT_GE(submaps.size(), 4U);
  const auto drift = [&](double travelled_m) {
    return std::pow(config().errors.drift_m_per_sqrt_m, 2) * travelled_m;
  };
  for (std::size_t i = 1; i < submaps.size(); ++i) {
    const auto& covariance = submaps[i].previous_from_submap.covariance;
    // Matches along this street are a little less sure than what the settings say.
    EXPECT_GE(covariance(0, 0), 0.99 * drift(submaps[i - 1].travelled_m)) << i;
    EXPECT_LE(covariance(0, 0), 1.5 * drift(submaps[i - 1].travelled_m)) << i;
    EXPECT_GT(covariance(2, 2), 0.0);
  }
}

TEST_F(OverSeveralSubmaps, TheSameDriveGivesTheSameBits) {
  Localizer first(config());
  const auto first_submaps = submaps_of_drive(first);
  const auto first_scans = std::exchange(scans_, {});
  Localizer second(config());
  const auto second_submaps = submaps_of_drive(second);
  ASSERT_EQ(first_submaps.size(), second_submaps.size());
  for (std::size_t i = 0; i < first_submaps.size(); ++i)
    EXPECT_TRUE(slammot::testing::same_submap(first_submaps[i], second_submaps[i]));
  for (std::size_t i = 0; i < first_scans.size(); ++i) {
    EXPECT_EQ(first_scans[i].odom_from_base.pose, scans_[i].odom_from_base.pose);
    EXPECT_EQ(first_scans[i].odom_from_base.covariance, scans_[i].odom_from_base.covariance);
  }
  EXPECT_EQ(first.checkpoint(), second.checkpoint());
}

TEST_F(OverSeveralSubmaps, FinishingTwiceEndsTheLastOneOnce) {
  Localizer localizer(config());
  const auto submaps = submaps_of_drive(localizer);
  localizer.finish();
  EXPECT_FALSE(localizer.take_finished_submap());
}

TEST_F(OverSeveralSubmaps, AfterFinishingTheDriveMayGoOnInTheNextOne) {
  Localizer localizer(config());
  const auto submaps = submaps_of_drive(localizer);
  SimulatedDrive drive(along_a_street());
  drive_through(localizer, drive, 200, 210);
  localizer.finish();
  const auto next = localizer.take_finished_submap();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->submap_id.value, submaps.back().submap_id.value + 1);
  EXPECT_GT(next->first_stamp_ns, submaps.back().last_stamp_ns);
}

TEST(Localizer, FinishedBeforeItBeganHasNoSubmap) {
  Localizer localizer(small_map_config());
  localizer.finish();
  EXPECT_FALSE(localizer.take_finished_submap());
}

TEST(Localizer, TakesTheNewestCorrectionOfTheMapWithoutMovingInOdom) {
  SimulatedDrive drive(round_in_a_room());
  Localizer localizer(small_map_config());
  const auto before = drive_one(localizer, drive, 0);
  EXPECT_EQ(before->map_from_odom, Pose2{});
  localizer.correct({5, {1.0, 2.0, 0.1}, {}});
  localizer.correct({4, {9.0, 9.0, 0.9}, {}});
  const auto after = drive_one(localizer, drive, 1);
  EXPECT_EQ(after->map_from_odom, (Pose2{1.0, 2.0, 0.1}));
  EXPECT_THAT(after->odom_from_base.pose, PoseNear(drive.odom_from_base(1), 0.03));
}

}  // namespace
}  // namespace slammot::localization
