#include "common/files/carmen_survey.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::files {
namespace {

using geometry::Pose2;
using sensing::ClockFault;
using std::numbers::pi;
using testing::PoseNear;

constexpr std::int64_t kSecond = 1'000'000'000;

struct Drive {
  int scans = 50;
  double step_m = 0.1;
  std::int64_t period_ns = kSecond / 10;
  std::int64_t first_ipc_ns = 1'000 * kSecond;
};

LaserRecord scan_of_drive(const Drive& drive, int i) {
  LaserRecord record;
  record.range_m = {1.0F + 0.01F * static_cast<float>(i), 2.0F + 0.03F * static_cast<float>(i),
                    81.83F, 81.83F};
  record.wheel_from_base = {drive.step_m * i, 0.0, 0.0};
  record.stamps = {drive.first_ipc_ns + i * drive.period_ns, i * drive.period_ns};
  return record;
}

LogPlan plan_of(const Drive& drive) {
  CarmenSurvey survey;
  for (int i = 0; i < drive.scans; ++i) survey.add(scan_of_drive(drive, i));
  return survey.conclude(pi);
}

/// A drive whose scans and ODOM lines were changed before the survey saw them.
template <typename Change>
LogPlan plan_of_changed_scans(Change change) {
  CarmenSurvey survey;
  for (int i = 0; i < 50; ++i) {
    LaserRecord record = scan_of_drive({}, i);
    change(record, i);
    survey.add(record);
  }
  return survey.conclude(pi);
}

TEST(CarmenSurvey, TellsTheFiguresOfADrive) {
  const LogFigures figures = plan_of({.scans = 101, .step_m = 0.5}).figures;
  EXPECT_EQ(figures.scans, 101u);
  EXPECT_EQ(figures.beams, 4u);
  EXPECT_NEAR(figures.scan_period_s, 0.1, 1e-9);
  EXPECT_NEAR(figures.scan_period_spread, 0.0, 1e-9);
  EXPECT_NEAR(figures.duration_s, 10.0, 1e-9);
  EXPECT_NEAR(figures.distance_m, 50.0, 1e-9);
  EXPECT_NEAR(figures.cruising_speed_mps, 5.0, 1e-9);
  EXPECT_NEAR(figures.field_of_view_rad, pi, 1e-9);
  EXPECT_NEAR(figures.median_range_m, 2.0, 0.05);
}

TEST(CarmenSurvey, TakesTheIpcClockWhenItRuns) { EXPECT_EQ(plan_of({}).clock, LogClock::kIpc); }

TEST(CarmenSurvey, TakesTheLoggersClockWhenIpcStandsStillOrIsMissing) {
  EXPECT_EQ(plan_of_changed_scans([](LaserRecord& r, int) { r.stamps.ipc_ns = 0; }).clock,
            LogClock::kLogger);
  EXPECT_EQ(plan_of_changed_scans([](LaserRecord& r, int) { r.stamps.ipc_ns.reset(); }).clock,
            LogClock::kLogger);
}

TEST(CarmenSurvey, MakesTimeOfTheWayWhereScansAreOnlyNumbered) {
  const auto plan = plan_of_changed_scans(
      [](LaserRecord& r, int i) { r.stamps.ipc_ns = r.stamps.logger_ns = i * kSecond; });
  EXPECT_EQ(plan.clock, LogClock::kNominal);
  EXPECT_EQ(plan.times.fault, ClockFault::kIndex);
  EXPECT_NEAR(plan.figures.scan_period_s, 0.1 / 0.5, 1e-9);  // 0.1 m a scan among walls 2 m away
  EXPECT_EQ(plan.figures.cruising_speed_mps, 0.0);
  EXPECT_FALSE(plan.figures.has_clock);
}

TEST(CarmenSurvey, KeepsTheNominalRateWhereNothingMovesAndNoClockRuns) {
  const auto plan = plan_of_changed_scans([](LaserRecord& r, int) {
    r.stamps = {0, 0};
    r.wheel_from_base = {};
  });
  EXPECT_NEAR(plan.figures.scan_period_s, 1.0 / kNominalRateHz, 1e-12);
}

TEST(CarmenSurvey, SpreadsWholeSecondsWithinThem) {
  const auto plan = plan_of_changed_scans(
      [](LaserRecord& r, int i) { r.stamps.ipc_ns = r.stamps.logger_ns = i / 10 * kSecond; });
  EXPECT_EQ(plan.clock, LogClock::kIpc);
  EXPECT_EQ(plan.times.fault, ClockFault::kCoarse);
  EXPECT_TRUE(plan.figures.has_clock);
  EXPECT_NEAR(plan.figures.scan_period_s, 0.1, 0.01);
}

TEST(CarmenSurvey, BridgesStampsThatStartAnew) {
  const auto plan = plan_of_changed_scans(
      [](LaserRecord& r, int i) { r.stamps.ipc_ns = r.stamps.logger_ns = i % 25 * kSecond / 10; });
  EXPECT_EQ(plan.times.fault, ClockFault::kJumps);
  EXPECT_EQ(plan.times.jumps, 1u);
  ASSERT_EQ(plan.times.stamps_ns.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_EQ(plan.times.stamps_ns[i], static_cast<std::int64_t>(i) * kSecond / 10);
}

TEST(CarmenSurvey, KeepsAClockThatRepeatsNowAndThen) {
  const auto plan = plan_of_changed_scans([](LaserRecord& r, int i) {
    if (i % 20 == 0) *r.stamps.ipc_ns -= kSecond / 10;
  });
  EXPECT_EQ(plan.clock, LogClock::kIpc);
}

TEST(CarmenSurvey, FindsTheReadingThatMeansNoEcho) {
  EXPECT_EQ(plan_of({}).max_range_m, static_cast<double>(81.83F));
  const auto several =
      plan_of_changed_scans([](LaserRecord& r, int i) { r.range_m[3] = i % 2 ? 81.91F : 81.83F; });
  EXPECT_EQ(several.max_range_m, static_cast<double>(81.83F));
}

TEST(CarmenSurvey, TakesEveryReadingForAnEchoWhereTheFarEndDoesNotRepeat) {
  const auto plan = plan_of_changed_scans([](LaserRecord& r, int i) {
    r.range_m[2] = r.range_m[3] = 5.0F + 0.07F * static_cast<float>(i);
  });
  EXPECT_GT(plan.max_range_m, static_cast<double>(5.0F + 0.07F * 49.0F));
}

TEST(CarmenSurvey, BelievesTheRecordsMaximumUnlessTheDataKnowASmallerOne) {
  EXPECT_EQ(plan_of_changed_scans([](LaserRecord& r, int) { r.max_range_m = 50.0; }).max_range_m,
            50.0);
  EXPECT_EQ(plan_of_changed_scans([](LaserRecord& r, int) { r.max_range_m = 100.0; }).max_range_m,
            static_cast<double>(81.83F));
}

TEST(CarmenSurvey, IgnoresAMaximumBelowManyReadings) {
  const auto plan = plan_of_changed_scans([](LaserRecord& r, int i) {
    r.max_range_m = 3.0;
    r.range_m[1] = r.range_m[2] = 5.0F + 0.11F * static_cast<float>(i);
  });
  EXPECT_EQ(plan.max_range_m, static_cast<double>(81.83F));
  ASSERT_EQ(plan.scanners.size(), 1u);
  EXPECT_EQ(plan.scanners.front().refuted_max_range_m, 3.0);
}

TEST(CarmenSurvey, PlacesTheLaserByParamElseByTheRecordsTwoPoses) {
  const auto by_record = plan_of_changed_scans([](LaserRecord& r, int) {
    r.base_from_laser = Pose2{0.3, 0.1, 0.2};
  });
  EXPECT_THAT(by_record.base_from_laser, PoseNear(Pose2{0.3, 0.1, 0.2}, 1e-12));
  const auto corrected = plan_of_changed_scans([](LaserRecord& r, int i) {
    r.base_from_laser = Pose2{0.3 * i, 0.1, 0.2};
  });
  EXPECT_THAT(corrected.base_from_laser, PoseNear(Pose2{}, 1e-12));
  CarmenSurvey survey;
  survey.add(ParamRecord{"robot_frontlaser_offset", "2.15"});
  LaserRecord record = scan_of_drive({}, 0);
  record.base_from_laser = Pose2{0.3, 0.1, 0.2};
  survey.add(record);
  EXPECT_THAT(survey.conclude(pi).base_from_laser, PoseNear(Pose2{2.15, 0.0, 0.0}, 1e-12));
}

TEST(CarmenSurvey, ReadsTheKindOfLaserRecordThatIsMoreFrequent) {
  CarmenSurvey survey;
  for (int i = 0; i < 10; ++i) {
    LaserRecord record = scan_of_drive({}, i);
    record.kind = i < 7 ? LaserRecordKind::kRobotLaser1 : LaserRecordKind::kFlaser;
    survey.add(record);
  }
  EXPECT_EQ(survey.conclude(pi).laser, LaserRecordKind::kRobotLaser1);
  EXPECT_EQ(survey.conclude(pi).figures.scans, 7u);
}

/// ODOM lines 5 ms after each scan, displaced by an offset that grows with the scan.
OdometrySource odometry_source(double laser_step_m, double odom_step_m) {
  CarmenSurvey survey;
  for (int i = 0; i < 50; ++i) {
    const LaserRecord record = scan_of_drive({.step_m = laser_step_m}, i);
    survey.add(record);
    survey.add(OdometryRecord{{odom_step_m * i, 0.0, 0.0},
                              {*record.stamps.ipc_ns + 5'000'000, std::nullopt}});
  }
  return survey.conclude(pi).odometry;
}

TEST(CarmenSurvey, TellsOdometryThatComesLessOftenThanScans) {
  const auto held_scans = [](int every, int stands_for) {
    CarmenSurvey survey;
    for (int i = 0; i < 200; ++i) {
      LaserRecord record = scan_of_drive({}, i);
      const int moved = std::max(0, i - stands_for);
      record.wheel_from_base = {0.1 * (moved / every * every), 0.0, 0.0};
      survey.add(record);
    }
    return survey.conclude(pi).odometry_held_scans;
  };
  EXPECT_EQ(held_scans(1, 0), 0U);
  EXPECT_EQ(held_scans(1, 150), 0U) << "it stands for most of the drive";
  EXPECT_EQ(held_scans(4, 0), 7U) << "three repeat one";
  EXPECT_EQ(held_scans(4, 80), 7U);
}

TEST(CarmenSurvey, DoesWithoutOdometryThatComesSeldomWhereScansComeOften) {
  const auto plan_with = [](int every, std::int64_t period_ns) {
    CarmenSurvey survey;
    for (int i = 0; i < 1000; ++i) {
      LaserRecord record = scan_of_drive({.period_ns = period_ns}, i);
      record.wheel_from_base = {0.1 * (i / every * every), 0.0, 0.0};
      survey.add(record);
    }
    return survey.conclude(pi);
  };
  const LogPlan rare = plan_with(30, kSecond / 40);
  EXPECT_TRUE(rare.odometry_is_too_rare);
  EXPECT_EQ(rare.odometry, OdometrySource::kNone);
  EXPECT_EQ(rare.odometry_held_scans, 0U);
  EXPECT_EQ(plan_with(4, kSecond / 40).odometry, OdometrySource::kLaserRecords);
  EXPECT_EQ(plan_with(30, kSecond / 10).odometry, OdometrySource::kLaserRecords);
}

TEST(CarmenSurvey, SmoothsNoisyOdometryAndDoesNotUseWhatIsTooNoisy) {
  const auto plan_with = [](double noise_m, std::int64_t period_ns) {
    CarmenSurvey survey;
    for (int i = 0; i < 200; ++i) {
      LaserRecord record = scan_of_drive({.period_ns = period_ns}, i);
      record.wheel_from_base.y_m = noise_m * (i * i % 7 - 3) / 3.0;
      survey.add(record);
    }
    return survey.conclude(pi);
  };
  constexpr std::int64_t kOften = kSecond / 40;
  const LogPlan sound = plan_with(1e-5, kOften);
  EXPECT_EQ(sound.odometry_smoothed_over, 0U);
  EXPECT_EQ(sound.odometry, OdometrySource::kLaserRecords);
  const LogPlan noisy = plan_with(3e-3, kOften);
  EXPECT_EQ(noisy.odometry_smoothed_over, 10U);
  EXPECT_EQ(noisy.odometry, OdometrySource::kLaserRecords);
  const LogPlan too_noisy = plan_with(3e-2, kOften);
  EXPECT_TRUE(too_noisy.odometry_is_too_noisy);
  EXPECT_EQ(too_noisy.odometry, OdometrySource::kNone);
  const LogPlan at_ten_hertz = plan_with(3e-2, kSecond / 10);
  EXPECT_EQ(at_ten_hertz.odometry_smoothed_over, 3U) << "scans alone do not suffice";
  EXPECT_EQ(at_ten_hertz.odometry, OdometrySource::kLaserRecords);
  EXPECT_EQ(plan_with(3e-2, kSecond).odometry_smoothed_over, 0U) << "a robot with rare scans";
}

TEST(CarmenSurvey, UsesOdomLinesOnlyWhereTheyDoNotContradictTheLaserRecords) {
  EXPECT_EQ(odometry_source(0.1, 0.1), OdometrySource::kBoth);
  EXPECT_EQ(odometry_source(0.1, 0.5), OdometrySource::kLaserRecords);
  EXPECT_EQ(odometry_source(0.1, 0.0), OdometrySource::kLaserRecords);
  EXPECT_EQ(odometry_source(0.0, 0.1), OdometrySource::kOdomLines);
  EXPECT_EQ(odometry_source(0.0, 0.0), OdometrySource::kNone);
}

/// Range of a beam in a room from (-1, -2) to (11, 3) m with a pillar-like step in one wall.
float range_in_room_m(const Pose2& laser, double beam_rad) {
  const double direction_rad = laser.heading_rad + beam_rad;
  for (double range_m = 0.0; range_m < 20.0; range_m += 0.01) {
    const double x_m = laser.x_m + range_m * std::cos(direction_rad);
    const double y_m = laser.y_m + range_m * std::sin(direction_rad);
    const bool is_inside =
        x_m > -1.0 && x_m < 11.0 && y_m > -2.0 && y_m < (x_m > 4.0 && x_m < 6.0 ? 2.0 : 3.0);
    if (!is_inside) return static_cast<float>(range_m);
  }
  return 20.0F;
}

/// Scans a decimetre apart: in millimetres each is a hundred units from the one before.
TEST(CarmenSurvey, TellsOdometryInMillimetresWhereScansFollowEachOtherClosely) {
  CarmenSurvey survey;
  for (int i = 0; i < 80; ++i) {
    const Pose2 pose{0.1 * i, 0.0, 0.25 * std::sin(0.15 * i)};
    LaserRecord record = scan_of_drive({}, i);
    record.range_m.clear();
    for (int beam = 0; beam < 181; ++beam)
      record.range_m.push_back(range_in_room_m(pose, pi * (beam / 180.0 - 0.5)));
    record.wheel_from_base = {1e3 * pose.x_m, 1e3 * pose.y_m, pose.heading_rad};
    survey.add(record);
  }
  const LogPlan plan = survey.conclude(pi);
  EXPECT_EQ(plan.evidence.correction.way_unit_m, 1e-3);
  EXPECT_NEAR(plan.figures.distance_m, 7.9, 0.1);
}

/// Scan of a hall of 30 x 20 m by a scanner whose beams meet the floor 5 m ahead of it.
LaserRecord scan_of_a_hall(const Pose2& world_from_laser) {
  constexpr std::size_t kHallBeams = 181;
  LaserRecord record;
  record.wheel_from_base = world_from_laser;
  for (std::size_t beam = 0; beam < kHallBeams; ++beam) {
    const double angle_rad = (static_cast<double>(beam) - 90.0) * pi / 180.0;
    const double x = std::cos(world_from_laser.heading_rad + angle_rad);
    const double y = std::sin(world_from_laser.heading_rad + angle_rad);
    const double end_m = (std::copysign(15.0, x) - world_from_laser.x_m) / x;
    const double side_m = (std::copysign(10.0, y) - world_from_laser.y_m) / y;
    const double floor_m = 5.0 / std::max(1e-3, std::cos(angle_rad));
    record.range_m.push_back(static_cast<float>(std::min({end_m, side_m, floor_m})));
  }
  return record;
}

TEST(CarmenSurvey, FindsTheFloorThatAScannerLooksDownAt) {
  CarmenSurvey survey;
  for (int i = 0; i < 200; ++i) {
    LaserRecord record = scan_of_a_hall(
        {9.0 * std::sin(0.1 * i), 6.0 * std::sin(0.13 * i), geometry::wrap_angle(0.07 * i + 0.01)});
    record.stamps = {kSecond + i * kSecond / 10, i * kSecond / 10};
    survey.add(record);
  }
  const sensing::FloorInView floor = survey.conclude(pi).scanners.front().floor;
  ASSERT_TRUE(floor.is_left_out());
  EXPECT_NEAR(floor.distance_m, 5.0, 0.1);
  EXPECT_LT(floor.from[90], 5.0F);
}

}  // namespace
}  // namespace slammot::files
