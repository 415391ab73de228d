#include "common/files/carmen_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/files/line_reader.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using geometry::Pose2;
using sensing::LaserScan;
using sensing::Odometry;
using ::testing::ElementsAre;
using testing::FlaserLine;
using ::testing::HasSubstr;
using testing::PoseNear;
using testing::straight_drive;
using testing::write_file;
using testing::write_gz;

struct Reading {
  std::vector<Odometry> odometry;
  std::vector<LaserScan> scans;
  std::string order;  // 'o' and 's' as they came
  LogFaults faults;
  LogPlan plan;
};

class CarmenLogTest : public ::testing::Test {
 protected:
  Reading read(const std::string& content) {
    write_file(file_, content);
    return read();
  }

  /// Out of what opening kept; reading again what was too much to keep must give the same.
  Reading read() {
    const Reading kept = read_with({});
    CarmenLogOptions keeps_nothing;
    keeps_nothing.most_kept_bytes = 0;
    const Reading again = read_with(keeps_nothing);
    EXPECT_EQ(kept.order, again.order);
    for (std::size_t i = 0; i < std::min(kept.scans.size(), again.scans.size()); ++i) {
      EXPECT_EQ(kept.scans[i].stamp_ns, again.scans[i].stamp_ns);
      EXPECT_EQ(kept.scans[i].sequence, again.scans[i].sequence);
      EXPECT_EQ(kept.scans[i].range_m, again.scans[i].range_m);
    }
    for (std::size_t i = 0; i < std::min(kept.odometry.size(), again.odometry.size()); ++i) {
      EXPECT_EQ(kept.odometry[i].stamp_ns, again.odometry[i].stamp_ns);
      EXPECT_EQ(kept.odometry[i].wheel_from_base, again.odometry[i].wheel_from_base);
    }
    EXPECT_EQ(kept.faults.malformed_lines, again.faults.malformed_lines);
    EXPECT_EQ(kept.faults.first_malformed_lines, again.faults.first_malformed_lines);
    EXPECT_EQ(kept.faults.overlong_lines, again.faults.overlong_lines);
    EXPECT_EQ(kept.faults.ignored_lines, again.faults.ignored_lines);
    EXPECT_EQ(kept.faults.stale_odometry, again.faults.stale_odometry);
    EXPECT_EQ(kept.faults.is_cut, again.faults.is_cut);
    return kept;
  }

  Reading read_with(const CarmenLogOptions& options) {
    Reading reading;
    auto log = CarmenLog::open(file_, options);
    EXPECT_TRUE(log);
    if (!log) return reading;
    double fraction_read = 0.0;
    while (const auto event = log->next()) {
      if (const auto* scan = std::get_if<LaserScan>(&*event)) reading.scans.push_back(*scan);
      if (const auto* odometry = std::get_if<Odometry>(&*event))
        reading.odometry.push_back(*odometry);
      reading.order += std::holds_alternative<LaserScan>(*event) ? 's' : 'o';
      EXPECT_GE(log->fraction_read(), fraction_read);
      fraction_read = log->fraction_read();
    }
    reading.faults = log->faults();
    reading.plan = log->plan();
    return reading;
  }

  std::string refusal(const std::string& content) {
    write_file(file_, content);
    const auto log = CarmenLog::open(file_);
    EXPECT_FALSE(log);
    return log ? "" : log.error().message;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "drive.log";
};

TEST_F(CarmenLogTest, GivesEachScanRightAfterTheOdometryOfItsStamp) {
  const Reading reading = read(straight_drive(3));
  EXPECT_EQ(reading.order, "ososos");
  EXPECT_EQ(reading.scans[1].stamp_ns, 1'000'100'000'000);
  EXPECT_EQ(reading.odometry[1].stamp_ns, reading.scans[1].stamp_ns);
  EXPECT_THAT(reading.odometry[1].wheel_from_base, PoseNear(Pose2{0.1, 0.0, 0.0}, 1e-12));
  EXPECT_EQ(reading.scans[2].sequence, 2u);
  EXPECT_NEAR(reading.scans[0].scanner.first_beam_rad, -std::numbers::pi / 2.0, 1e-12);
  EXPECT_THAT(reading.scans[0].range_m, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F));
}

TEST_F(CarmenLogTest, TakesTheTurnsOfOdometryFromAnImu) {
  // Standing, then on the spot: the wheels count 0.6 rad/s, the gyro 0.5. One of its stamps is an
  // hour ahead.
  std::string log;
  for (int i = 0; i < 100; ++i) {
    if (i == 20) log += "IMU 0 0 9.81 1 0 0 0 0 0 0 0 0 0.5 4600 host 2\n";
    const std::string s = std::to_string(i / 10) + "." + std::to_string(i % 10);
    const std::string rate = i < 50 ? "0 " : "0.5 ";
    const std::string heading = std::to_string(0.06 * std::max(0, i - 50));
    log += "IMU 0 0 9.81 1 0 0 0 0 0 0 0 0 " + rate + "100" + s + " host " + s + "\n";
    log += FlaserLine{.pose = "0 0 " + heading, .ipc = "100" + s, .logger = s}.text();
  }
  const Reading reading = read(log);
  ASSERT_EQ(reading.odometry.size(), 100U);
  const double turned_rad = reading.odometry[99].wheel_from_base.heading_rad -
                            reading.odometry[79].wheel_from_base.heading_rad;
  EXPECT_NEAR(turned_rad, 1.0, 0.02);
}

/// Like straight_drive(), for more than ten seconds.
std::string long_drive(int scans) {
  std::string log;
  for (int i = 0; i < scans; ++i) {
    const std::string s = std::to_string(100 + i / 10) + "." + std::to_string(i % 10);
    log += FlaserLine{.pose = s + " 0 0", .ipc = "1" + s, .logger = s}.text();
  }
  return log;
}

/// The lines of a log, each so many of them backwards.
std::string backwards_by(std::size_t lines_at_a_time, const std::string& log) {
  std::vector<std::string> lines;
  std::istringstream text(log);
  for (std::string line; std::getline(text, line);) lines.push_back(line + "\n");
  for (std::size_t i = 0; i + lines_at_a_time <= lines.size(); i += lines_at_a_time)
    std::reverse(lines.begin() + static_cast<std::ptrdiff_t>(i),
                 lines.begin() + static_cast<std::ptrdiff_t>(i + lines_at_a_time));
  std::string result;
  for (const std::string& line : lines) result += line;
  return result;
}

TEST_F(CarmenLogTest, ExtrapolatesOdometryThatBeginsAfterTheFirstScans) {
  std::string log;
  for (int i = 0; i < 40; ++i) {
    const std::string s = std::to_string(100 + i / 10) + "." + std::to_string(i % 10);
    log += FlaserLine{.pose = "0 0 0", .ipc = "1" + s, .logger = s}.text();
    if (i >= 2) log += "ODOM " + s + " 0 0 0 0 0 1" + s + " host " + s + "\n";
  }
  const Reading reading = read(log);
  ASSERT_GE(reading.odometry.size(), 4U);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(reading.odometry[static_cast<std::size_t>(i)].wheel_from_base.x_m, 100.0 + 0.1 * i,
                1e-6);
}

TEST_F(CarmenLogTest, SortsScansThatWereLoggedInAnotherOrder) {
  const Reading in_order = read(long_drive(400));
  const Reading reading = read(backwards_by(5, long_drive(400)));
  ASSERT_EQ(reading.scans.size(), in_order.scans.size());
  for (std::size_t i = 0; i < reading.scans.size(); ++i) {
    EXPECT_EQ(reading.scans[i].stamp_ns, in_order.scans[i].stamp_ns);
    EXPECT_EQ(reading.odometry[i].wheel_from_base, in_order.odometry[i].wheel_from_base);
  }
  EXPECT_TRUE(reading.plan.scans_are_sorted);
  EXPECT_FALSE(in_order.plan.scans_are_sorted);
}

/// ODOM lines 20 times a second and a scan each 0.2 s, at 1 m/s along x from x = 5 m; of the
/// records whose number leaves 30 over by 49, counted together, the pose is zero.
std::string drive_with_zeros(bool scans_have_poses) {
  std::string log;
  for (int i = 0; i < 1000; ++i) {
    const std::string s = std::to_string(100.0 + 0.05 * i);
    const std::string pose = i % 49 == 30 ? "0 0 0" : std::to_string(5.0 + 0.05 * i) + " 0 0";
    if (i % 5 == 0)
      log +=
          FlaserLine{.pose = scans_have_poses ? pose : "0 0 0", .ipc = "1" + s, .logger = s}.text();
    else log += "ODOM " + pose + " 0 0 0 1" + s + " host " + s + "\n";
  }
  return log;
}

TEST_F(CarmenLogTest, LeavesOutStrayPosesOfScansAndOfOdometryLines) {
  for (const bool scans_have_poses : {true, false}) {
    const Reading reading = read(drive_with_zeros(scans_have_poses));
    ASSERT_EQ(reading.scans.size(), 200U);
    double before_m = 4.9;
    for (const Odometry& odometry : reading.odometry) {
      EXPECT_GE(odometry.wheel_from_base.x_m, before_m);
      EXPECT_LT(odometry.wheel_from_base.x_m, before_m + 0.2);
      before_m = odometry.wheel_from_base.x_m;
    }
    EXPECT_EQ(reading.plan.stray_odometry, scans_have_poses ? 20U : 16U);
  }
}

TEST_F(CarmenLogTest, LeavesStrayPosesWhereNothingIsKnownBefore) {
  write_file(file_, drive_with_zeros(true));
  CarmenLogOptions options;
  options.is_as_live = true;
  EXPECT_EQ(read_with(options).plan.stray_odometry, 0U);
}

TEST_F(CarmenLogTest, LeavesAFewLateScansToLocalization) {
  std::string log = long_drive(400);
  log += FlaserLine{.pose = "112.3 0 0", .ipc = "1112.3", .logger = "140.0"}.text();
  const Reading reading = read(log);
  EXPECT_FALSE(reading.plan.scans_are_sorted);
  EXPECT_LT(reading.scans.back().stamp_ns, reading.scans[399].stamp_ns);
}

TEST_F(CarmenLogTest, ReadsCompressedLogsAlike) {
  write_gz(file_, straight_drive(3));
  EXPECT_EQ(read().order, "ososos");
}

TEST_F(CarmenLogTest, GivesBackTheLogsOwnDigitsOfAStamp) {
  const Reading reading = read(FlaserLine{.ipc = "1575810072.324471"}.text() +
                               FlaserLine{.ipc = "1575810072.404310"}.text());
  ASSERT_EQ(reading.scans.size(), 2u);
  char text[64];
  std::snprintf(text, sizeof text, "%.6f", static_cast<double>(reading.scans[1].stamp_ns) * 1e-9);
  EXPECT_STREQ(text, "1575810072.404310");
}

TEST_F(CarmenLogTest, ReadsTheLaserOffsetWhereverItStands) {
  const Reading reading = read(straight_drive(2) + "PARAM robot_frontlaser_offset 2.150\n");
  EXPECT_THAT(reading.scans[0].scanner.base_from_laser, PoseNear(Pose2{2.15, 0.0, 0.0}, 1e-12));
}

TEST_F(CarmenLogTest, PutsOdomLinesThatAgreeBetweenTheScansInOrderOfTime) {
  const Reading reading = read(
      "ODOM 0.0 0 0 0 0 0 0.9 h 0.9\n" + FlaserLine{.pose = "0.1 0 0", .ipc = "1.0"}.text() +  //
      "ODOM 0.2 0 0 0 0 0 1.1 h 1.1\nODOM 0.1 0 0 0 0 0 1.0 h 1.0\nODOM 0.4 0 0 0 0 0 1.3 h 1.3\n" +
      FlaserLine{.pose = "0.3 0 0", .ipc = "1.2"}.text() +
      FlaserLine{.pose = "0.5 0 0", .ipc = "1.4"}.text());
  EXPECT_EQ(reading.plan.odometry, OdometrySource::kBoth);
  EXPECT_EQ(reading.order, "oosoosoos");
  for (std::size_t i = 1; i < reading.odometry.size(); ++i)
    EXPECT_GT(reading.odometry[i].stamp_ns, reading.odometry[i - 1].stamp_ns);
  EXPECT_EQ(reading.faults.stale_odometry, 1u);
}

TEST_F(CarmenLogTest, LeavesOutOdomLinesThatContradictTheLaserRecords) {
  const Reading reading =
      read(FlaserLine{.pose = "0.1 0 0", .ipc = "1.0"}.text() + "ODOM 7 0 0 0 0 0 1.05 h 1\n" +
           FlaserLine{.pose = "0.2 0 0", .ipc = "1.1"}.text() + "ODOM 8 0 0 0 0 0 1.15 h 1\n");
  EXPECT_EQ(reading.order, "osos");
}

TEST_F(CarmenLogTest, TakesOdometryFromWhereItIsUnlessTheUserSaysThatTheLaserIsThere) {
  write_file(file_, straight_drive(3));
  LogPlan plan;
  plan.odometry = OdometrySource::kLaserRecords;
  plan.max_range_m = 80.0;
  plan.evidence.correction.odometry_from_base = {2.0, 0.1, 0.0};
  const auto first = [&](const Pose2& fallback_base_from_laser) {
    auto lines = LineReader::open(file_);
    CarmenLogOptions options;
    options.fallback_base_from_laser = fallback_base_from_laser;
    CarmenLog log =
        CarmenLog::follow(std::make_unique<LineReader>(std::move(*lines)), plan, options);
    const auto odometry = std::get<Odometry>(*log.next());
    const auto scan = std::get<LaserScan>(*log.next());
    EXPECT_EQ(scan.scanner.base_from_laser, fallback_base_from_laser);
    return odometry.wheel_from_base;
  };
  EXPECT_THAT(first(Pose2::identity()), PoseNear(Pose2{2.0, 0.1, 0.0}, 1e-9));
  EXPECT_THAT(first({2.0, 0.0, 0.0}), PoseNear(Pose2{0.0, 0.0, 0.0}, 1e-9));
  EXPECT_THAT(first({0.5, 0.0, 0.0}), PoseNear(Pose2{1.5, 0.1, 0.0}, 1e-9));
}

TEST_F(CarmenLogTest, DoesNotCutReadingsAtAMaximumThatTheyExceed) {
  std::string log;
  for (int i = 0; i < 60; ++i) {
    const std::string far = std::to_string(10.0 + 0.2 * i);
    log += "ROBOTLASER1 0 -1.570796 3.141593 1.047197 8 0.01 0 4 1 " + far + " " + far +
           " 2 0 0 0 0 0 0 0 0 0.5 0.3 1000000 " + std::to_string(1000.0 + 0.1 * i) + " h " +
           std::to_string(0.1 * i) + "\n";
  }
  const Reading reading = read(log);
  ASSERT_EQ(reading.scans.size(), 60U);
  EXPECT_EQ(reading.plan.scanners.front().refuted_max_range_m, 8.0);
  EXPECT_GT(reading.scans.front().scanner.max_range_m, 21.0);
}

TEST_F(CarmenLogTest, SmoothsNoisyPoses) {
  std::string log;
  for (int i = 0; i < 200; ++i) {
    const std::string stamp = std::to_string(0.025 * i);
    const std::string pose =
        std::to_string(0.1 * i) + " " + std::to_string(0.001 * (i * i % 7 - 3)) + " 0";
    log +=
        FlaserLine{.pose = pose, .ipc = std::to_string(1000.0 + 0.025 * i), .logger = stamp}.text();
  }
  const Reading reading = read(log);
  EXPECT_EQ(reading.plan.odometry_smoothed_over, 10U);
  ASSERT_EQ(reading.odometry.size(), 200U);
  ASSERT_EQ(reading.scans.size(), 200U);
  for (std::size_t i = 20; i < 180; ++i) {
    EXPECT_EQ(reading.odometry[i].stamp_ns, reading.scans[i].stamp_ns);
    EXPECT_NEAR(reading.odometry[i].wheel_from_base.x_m, 0.1 * static_cast<double>(i), 1e-6);
    EXPECT_NEAR(
        reading.odometry[i].wheel_from_base.y_m - reading.odometry[i - 1].wheel_from_base.y_m, 0.0,
        3e-4)
        << i;
  }
}

TEST_F(CarmenLogTest, InterpolatesPosesThatScansRepeat) {
  std::string log;
  for (int i = 0; i < 200; ++i) {
    const std::string stamp = std::to_string(0.1 * i);
    const std::string way = std::to_string(0.1 * (std::max(0, i - 100) / 4 * 4));
    log += FlaserLine{.pose = way + " 0 0", .ipc = "100" + stamp, .logger = stamp}.text();
  }
  const Reading reading = read(log);
  ASSERT_EQ(reading.odometry.size(), 200U);
  for (std::size_t i = 0; i < 190; ++i) {
    const double way_m = 0.1 * std::max(0.0, static_cast<double>(i) - 100.0);
    EXPECT_NEAR(reading.odometry[i].wheel_from_base.x_m, way_m, 0.25) << i;
    EXPECT_EQ(reading.odometry[i].stamp_ns, reading.scans[i].stamp_ns);
  }
  for (std::size_t i = 110; i < 190; ++i)
    EXPECT_NEAR(
        reading.odometry[i].wheel_from_base.x_m - reading.odometry[i - 1].wheel_from_base.x_m, 0.1,
        1e-6)
        << i;
}

TEST_F(CarmenLogTest, InterpolatesOdomLinesForScansWhoseOwnPoseStandsStill) {
  const Reading reading = read("ODOM 0 0 0 0 0 0 1.0 h 0\n" + FlaserLine{.ipc = "1.25"}.text() +
                               "ODOM 1 0 0 0 0 0 2.0 h 0\n" + FlaserLine{.ipc = "2.5"}.text());
  EXPECT_EQ(reading.plan.odometry, OdometrySource::kOdomLines);
  EXPECT_EQ(reading.order, "oosoos");
  EXPECT_EQ(reading.odometry[1].stamp_ns, reading.scans[0].stamp_ns);
  EXPECT_THAT(reading.odometry[1].wheel_from_base, PoseNear(Pose2{0.25, 0.0, 0.0}, 1e-12));
  // held: nothing newer
  EXPECT_THAT(reading.odometry[3].wheel_from_base, PoseNear(Pose2{1.0, 0.0, 0.0}, 1e-12));
}

/// Way from inside a room of 5 by 4 m to its wall.
double range_in_room_m(double direction_rad) {
  const double x = std::cos(direction_rad), y = std::sin(direction_rad);
  const double across_m = (x > 0.0 ? 3.0 : 2.0) / std::max(std::abs(x), 1e-9);
  const double along_m = (y > 0.0 ? 2.5 : 1.5) / std::max(std::abs(y), 1e-9);
  return std::min(across_m, along_m);
}

/// Five scans a second all around, stamped at their first beams, and 25 poses by odometry, of a
/// robot that turns on the spot to and fro.
std::string drive_of_a_slow_scanner(int scans) {
  constexpr int kBeams = 360;
  constexpr double kPeriod_s = 0.2;
  const auto heading_rad = [](double time_s) { return 1.2 * std::sin(1.1 * time_s); };
  std::string log;
  for (int i = 0; i < 5 * scans; ++i) {
    const double time_s = 0.04 * i;
    const std::string stamp = std::to_string(1000 + time_s);
    const std::string pose = "0 0 " + std::to_string(heading_rad(time_s));
    log += "ODOM " + pose + " 0 0 0 " + stamp + " h " + stamp + "\n";
    if (i % 5 != 0) continue;
    log += "ROBOTLASER1 0 0 6.265732 0.017453 30 0.01 0 360";
    for (int beam = 0; beam < kBeams; ++beam)
      log += " " + std::to_string(range_in_room_m(0.017453 * beam +
                                                  heading_rad(time_s + kPeriod_s * beam / kBeams)));
    log += " 0 " + pose + " " + pose + " 0 0 0 0 0 " + stamp + " h " + stamp + "\n";
  }
  return log;
}

TEST_F(CarmenLogTest, GivesScansOfASlowFullTurnWithTheOdometryOfTheirSweep) {
  const Reading reading = read(drive_of_a_slow_scanner(30));
  ASSERT_EQ(reading.scans.size(), 30U);
  EXPECT_EQ(reading.order.substr(0, 13), "oooooosooooos");
  EXPECT_EQ(reading.faults.stale_odometry, 0U);
  for (std::size_t i = 1; i < reading.odometry.size(); ++i)
    EXPECT_LT(reading.odometry[i - 1].stamp_ns, reading.odometry[i].stamp_ns);
}

TEST_F(CarmenLogTest, GivesScansOfALogThatNeverMovesWithoutOdometry) {
  EXPECT_EQ(read(FlaserLine{.ipc = "1.0"}.text() + FlaserLine{.ipc = "1.1"}.text()).order, "ss");
}

TEST_F(CarmenLogTest, GivesNumberedScansTheTimeThatTheirWayTakes) {
  std::string content;
  for (int i = 0; i < 5; ++i)
    content += FlaserLine{.pose = std::to_string(i) + " 0 0",
                          .ipc = std::to_string(i),
                          .logger = std::to_string(i)}
                   .text();
  const Reading reading = read(content);
  EXPECT_EQ(reading.plan.clock, LogClock::kNominal);
  EXPECT_EQ(reading.scans[0].stamp_ns, 0);
  EXPECT_EQ(reading.scans[4].stamp_ns, 8'000'000'000);  // a metre each at 0.5 m/s
  EXPECT_EQ(reading.order, "ososososos");
}

TEST_F(CarmenLogTest, PlacesOdomLinesByTheirOrderWhereNoClockRuns) {
  std::string content = "ODOM 0 0 0 0 0 0 0 h 0\n";
  for (int i = 0; i < 4; ++i) {
    content += FlaserLine{.pose = std::to_string(i) + " 0 0", .ipc = "0", .logger = "0"}.text();
    content += "ODOM " + std::to_string(i) + ".5 0 0 0 0 0 0 h 0\n";
  }
  const Reading reading = read(content);
  EXPECT_EQ(reading.plan.odometry, OdometrySource::kBoth);
  EXPECT_EQ(reading.order, "osoosoosoos");
  EXPECT_EQ(reading.odometry[1].stamp_ns, 1'000'000'000);
  EXPECT_EQ(reading.odometry[2].stamp_ns, reading.scans[1].stamp_ns);
}

TEST_F(CarmenLogTest, TakesTheOdomLineBeforeAScanWithoutPoseWhereNoClockRuns) {
  std::string content;
  for (int i = 0; i < 4; ++i)
    content += "ODOM " + std::to_string(i) + " 0 0 0 0 0 0 h 0\n" +
               FlaserLine{.ipc = "0", .logger = "0"}.text();
  const Reading reading = read(content);
  EXPECT_EQ(reading.plan.odometry, OdometrySource::kOdomLines);
  EXPECT_EQ(reading.order, "osososos");
  EXPECT_THAT(reading.odometry[0].wheel_from_base, PoseNear(Pose2{0.0, 0.0, 0.0}, 1e-12));
  EXPECT_THAT(reading.odometry[2].wheel_from_base, PoseNear(Pose2{2.0, 0.0, 0.0}, 1e-12));
  EXPECT_EQ(reading.odometry[2].stamp_ns, reading.scans[2].stamp_ns);
}

TEST_F(CarmenLogTest, KeepsOtherScansOfEarlierStampsWithTheirOwnStampButWithoutOdometry) {
  std::string content = straight_drive(20);
  const std::string ranges = "4 1.1 2.0 3.0 4.0";
  content += FlaserLine{.ranges = ranges, .pose = "1.9 0 0", .ipc = "1001.9"}.text() +
             FlaserLine{.ranges = ranges, .pose = "1.7 0 0", .ipc = "1001.7"}.text();
  const Reading reading = read(content);
  ASSERT_EQ(reading.scans.size(), 22u);
  EXPECT_EQ(reading.odometry.size(), 20u);
  EXPECT_EQ(reading.scans[21].stamp_ns, 1'001'700'000'000);
}

TEST_F(CarmenLogTest, LeavesOutScansThatAreRecordedAgain) {
  const Reading reading = read(straight_drive(20) + straight_drive(20));
  EXPECT_EQ(read(straight_drive(20)).plan.repeated_scans, 0u);
  EXPECT_EQ(reading.plan.figures.scans, 40u) << "a log twice is two drives";
  const std::string drive = straight_drive(20);
  std::string twice;
  for (std::size_t at = 0; at < drive.size(); at = drive.find('\n', at) + 1) {
    const std::string line = drive.substr(at, drive.find('\n', at) + 1 - at);
    twice += line + line;
  }
  EXPECT_EQ(read(twice).scans.size(), 20u);
  EXPECT_EQ(read(twice).plan.repeated_scans, 20u);
}

TEST_F(CarmenLogTest, GivesAFirstScanFromTheFutureAfterTheSecondOne) {
  const std::string drive = straight_drive(20);
  const std::string rest = drive.substr(drive.find('\n') + 1);
  const Reading reading =
      read(FlaserLine{.pose = "0 0 0", .ipc = "5000.0", .logger = "4000.0"}.text() + rest);
  EXPECT_EQ(reading.plan.clock, LogClock::kIpc);  // all others advance
  ASSERT_EQ(reading.scans.size(), 20u);
  EXPECT_EQ(reading.scans[0].stamp_ns, 1'000'100'000'000);
  EXPECT_EQ(reading.scans[1].stamp_ns, 5'000'000'000'000);
  for (std::uint32_t i = 0; i < 20; ++i) EXPECT_EQ(reading.scans[i].sequence, i);
  EXPECT_EQ(reading.scans[2].stamp_ns, 1'000'200'000'000);
  EXPECT_EQ(reading.odometry.size(), 19u);
  EXPECT_EQ(reading.odometry.back().stamp_ns, 1'001'900'000'000);
}

TEST_F(CarmenLogTest, TakesTheFirstScanForGoodWhereItIsTheSecondThatIsFarBehind) {
  const std::string drive = straight_drive(20);
  const std::size_t second = drive.find('\n') + 1;
  const Reading reading =
      read(drive.substr(0, second) + FlaserLine{.ipc = "100.0", .logger = "1.0"}.text() +
           drive.substr(second));
  ASSERT_EQ(reading.scans.size(), 21u);
  EXPECT_EQ(reading.scans[0].stamp_ns, 1'000'000'000'000);
}

TEST_F(CarmenLogTest, SkipsMalformedLinesAndNamesTheFirstOnes) {
  std::string content = straight_drive(3);
  for (int i = 0; i < 7; ++i) content += "FLASER 3 1 2\n";
  const Reading reading = read(content + FlaserLine{.pose = "0.3 0 0", .ipc = "1000.3"}.text());
  EXPECT_EQ(reading.scans.size(), 4u);
  EXPECT_EQ(reading.faults.malformed_lines, 7u);
  EXPECT_THAT(reading.faults.first_malformed_lines, ElementsAre(4, 5, 6, 7, 8));
  EXPECT_FALSE(reading.faults.is_cut);
}

TEST_F(CarmenLogTest, SaysThatACutLogIsCut) {
  write_gz(file_, straight_drive(5'000));
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  const Reading reading = read();
  EXPECT_GT(reading.scans.size(), 100u);
  EXPECT_LT(reading.scans.size(), 5'000u);
  EXPECT_TRUE(reading.faults.is_cut);
}

TEST_F(CarmenLogTest, SaysThatAPlainLogEndsInTheMiddleOfARecord) {
  const std::string whole = straight_drive(5);
  const Reading reading = read(whole.substr(0, whole.size() - 20));
  EXPECT_EQ(reading.scans.size(), 4u);
  EXPECT_TRUE(reading.faults.is_cut);
  EXPECT_FALSE(read(whole.substr(0, whole.size() - 1)).faults.is_cut);
}

TEST_F(CarmenLogTest, RefusesFilesWithoutAScanInOneLine) {
  EXPECT_THAT(refusal(""), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("# CARMEN Logfile\nODOM 0 0 0 0 0 0 1 h 1\n"), HasSubstr("no laser scan"));
  EXPECT_THAT(refusal("FLASER 3 1 2\n"), HasSubstr("1 of them malformed"));
  EXPECT_THAT(refusal("FLASER 3 1 2 0 0 0 0 0 0 100.5 host 1\n"),
              HasSubstr("1 of them malformed (one of them: it does not hold as many ranges"));
  EXPECT_THAT(refusal(std::string("\x00\x01\xff\xfe garbage\n\x00", 13)),
              HasSubstr("no laser scan"));
  write_gz(file_, straight_drive(50));
  std::filesystem::resize_file(file_, 30);
  EXPECT_THAT(CarmenLog::open(file_).error().message, HasSubstr("cut off or damaged"));
}

TEST_F(CarmenLogTest, ReadsALogOfDpSlamByTheNominalClock) {
  const Reading reading =
      read("Odometry 0 0 0\nLaser 3 1 2 3\nOdometry 0.5 0 0.1\nLaser 3 1 2 3\n");
  EXPECT_EQ(reading.order, "osos");
  EXPECT_EQ(reading.plan.clock, LogClock::kNominal);
  EXPECT_THAT(reading.odometry[1].wheel_from_base, PoseNear(Pose2{0.5, 0.0, 0.1}, 1e-12));
  EXPECT_NEAR(reading.scans[0].scanner.first_beam_rad, -std::numbers::pi / 2.0, 1e-12);
}

TEST_F(CarmenLogTest, ReadsRawScansWithOdomLines) {
  const std::string raw = "RAWLASER1 0 -1.570796 3.141593 1.570796 81.83 0.01 0 3 1 2 3 0 ";
  const Reading reading =
      read("ODOM 0 0 0 0 0 0 1.0 h 1.0\n" + raw + "1.05 h 1.05\nODOM 0.1 0 0 0 0 0 1.1 h 1.1\n" +
           raw + "1.15 h 1.15\nODOM 0.2 0 0 0 0 0 1.2 h 1.2\n");
  EXPECT_EQ(reading.plan.odometry, OdometrySource::kOdomLines);
  ASSERT_EQ(reading.scans.size(), 2u);
  EXPECT_THAT(reading.odometry[1].wheel_from_base, PoseNear(Pose2{0.05, 0.0, 0.0}, 1e-9));
}

TEST_F(CarmenLogTest, PrefersTheRecordsWithPosesWhereTheSameScansAreThereTwice) {
  std::string log;
  for (int i = 0; i < 5; ++i) {
    const std::string stamp = "10" + std::to_string(i) + ".0";
    log += "RAWLASER1 0 -1.570796 3.141593 1.570796 81.83 0.01 0 3 1 2 3 0 " + stamp + " h " +
           stamp + "\n";
    log += FlaserLine{.pose = std::to_string(i) + " 0 0", .ipc = stamp, .logger = stamp}.text();
  }
  const Reading reading = read(log);
  EXPECT_EQ(reading.plan.laser, LaserRecordKind::kFlaser);
  EXPECT_EQ(reading.scans.size(), 5u);
  EXPECT_EQ(reading.plan.scanners.size(), 1u);
}

TEST_F(CarmenLogTest, TakesOdometryOfTruePosWhereThereIsNoOther) {
  const std::string raw = "RAWLASER1 0 -1.570796 3.141593 1.570796 81.83 0.01 0 3 1 2 3 0 ";
  const Reading reading = read("TRUEPOS 9 9 0 0 0 0 1.0 h 1.0\n" + raw +
                               "1.1 h 1.1\nTRUEPOS 9 9 0 0.2 0 0 1.2 h 1.2\n");
  EXPECT_EQ(reading.plan.odometry, OdometrySource::kOdomLines);
  ASSERT_EQ(reading.scans.size(), 1u);
  EXPECT_THAT(reading.odometry[1].wheel_from_base, PoseNear(Pose2{0.1, 0.0, 0.0}, 1e-9));
}

/// A front and a rear laser; records of the rear one come late.
std::string front_and_rear(int scans) {
  std::string log = "PARAM robot_frontlaser_offset 0.5\nPARAM robot_rearlaser_offset 0.4\n";
  for (int i = 0; i < scans; ++i) {
    const std::string s = std::to_string(i / 10) + "." + std::to_string(i % 10);
    log += FlaserLine{.pose = s + "5 0 0", .ipc = "100" + s + "5", .logger = s + "5"}.text();
    log += "R" +
           FlaserLine{.ranges = "3 5.0 6.0 7.0", .pose = s + " 0 0", .ipc = "100" + s, .logger = s}
               .text()
               .substr(1);
  }
  return log;
}

TEST_F(CarmenLogTest, KnowsTheRearLaserAndHandsOutTheFrontOne) {
  const Reading reading = read(front_and_rear(5));
  ASSERT_EQ(reading.plan.scanners.size(), 2u);
  EXPECT_EQ(reading.plan.scanners[1].name, "RLASER");
  EXPECT_THAT(reading.plan.scanners[1].base_from_laser,
              PoseNear(Pose2{-0.4, 0.0, std::numbers::pi}, 1e-12));
  EXPECT_EQ(reading.scans.size(), 5u);
  EXPECT_EQ(reading.scans[4].scanner.scanner_id, "front");
}

TEST_F(CarmenLogTest, HandsOutTheRearLaserWhereAskedFor) {
  write_file(file_, front_and_rear(5));
  CarmenLogOptions options;
  options.topics.scan_topic = "RLASER";
  const Reading reading = read_with(options);
  ASSERT_EQ(reading.scans.size(), 5u);
  EXPECT_EQ(reading.scans[0].range_m.size(), 3u);
  EXPECT_THAT(reading.scans[0].scanner.base_from_laser,
              PoseNear(Pose2{-0.4, 0.0, std::numbers::pi}, 1e-12));
  options.topics.scan_topic = "ROBOTLASER7";
  EXPECT_THAT(CarmenLog::open(file_, options).error().message, HasSubstr("no scanner ROBOTLASER7"));
}

TEST_F(CarmenLogTest, HandsOutAllLasersInTheOrderOfTheirStampsWhereAskedFor) {
  write_file(file_, front_and_rear(5));
  CarmenLogOptions options;
  options.uses_all_scanners = true;
  const Reading reading = read_with(options);
  ASSERT_EQ(reading.scans.size(), 10u);
  for (std::size_t i = 0; i < reading.scans.size(); ++i) {
    EXPECT_EQ(reading.scans[i].scanner.scanner_id, i % 2 == 0 ? "RLASER" : "FLASER");
    EXPECT_EQ(reading.scans[i].sequence, i / 2);
    if (i > 0) EXPECT_GT(reading.scans[i].stamp_ns, reading.scans[i - 1].stamp_ns);
  }
  EXPECT_EQ(reading.order, "osososososososososos");
}

TEST_F(CarmenLogTest, SaysOfAFurtherLaserThatItIsUsedOnlyWhereItIs) {
  write_file(file_, front_and_rear(5));
  CarmenLogOptions options;
  const auto front = CarmenLog::open(file_, options);
  ASSERT_TRUE(front);
  EXPECT_THAT(describe(front->topics()), HasSubstr("not used: RLASER"));
  options.uses_all_scanners = true;
  const auto both = CarmenLog::open(file_, options);
  ASSERT_TRUE(both);
  EXPECT_THAT(describe(both->topics()), ::testing::Not(HasSubstr("not used")));
}

std::string without_rear_offset(std::string log) {
  const std::string line = "PARAM robot_rearlaser_offset 0.4\n";
  return log.erase(log.find(line), line.size());
}

TEST_F(CarmenLogTest, LeavesOutAFurtherLaserOfWhichItDoesNotKnowWhereItIs) {
  write_file(file_, without_rear_offset(front_and_rear(5)));
  CarmenLogOptions options;
  options.uses_all_scanners = true;
  const Reading reading = read_with(options);
  EXPECT_EQ(reading.scans.size(), 5u);
  EXPECT_EQ(reading.scans[0].scanner.scanner_id, "front");
  EXPECT_THAT(reading.plan.unplaced_scanners, ::testing::ElementsAre("RLASER"));
}

TEST_F(CarmenLogTest, UsesTheLasersThatWereAskedForOnly) {
  write_file(file_, without_rear_offset(front_and_rear(5)));
  CarmenLogOptions options;
  options.uses_all_scanners = true;
  options.topics.scanners = {"RLASER"};
  const Reading reading = read_with(options);
  ASSERT_EQ(reading.scans.size(), 5u);
  EXPECT_EQ(reading.scans[0].range_m[0], 5.0F);
  EXPECT_EQ(reading.plan.base_from_laser.heading_rad, std::numbers::pi);
  options.topics.scanners = {"RLASER", "LASER3"};
  const auto refused = CarmenLog::open(file_, options);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("no scanner LASER3: there are FLASER, RLASER"));
}

TEST_F(CarmenLogTest, KnowsWhereNumberedLasersAre) {
  std::string log =
      "PARAM robot_laser2_offset 0.4\nPARAM robot_laser2_side_offset -0.2\nPARAM "
      "robot_laser2_angular_offset 1.5\n" +
      front_and_rear(5);
  EXPECT_THAT(read(log).plan.scanners.at(1).base_from_laser,
              PoseNear(Pose2{0.4, -0.2, 1.5}, 1e-12));
}

const std::string kTiltOfTheRearOne =
    "PARAM robot_laser2_offset 0.4\nPARAM robot_laser2_up_offset 2.1\nPARAM "
    "robot_laser2_roll_offset 1.570796\n";

TEST_F(CarmenLogTest, KeepsTheScansOfAVerticalLaserFromLocalization) {
  CarmenLogOptions options;
  options.uses_all_scanners = true;
  write_file(file_, kTiltOfTheRearOne + front_and_rear(5));
  const Reading reading = read_with(options);
  EXPECT_EQ(reading.scans.size(), 5u);
  EXPECT_EQ(reading.plan.scanners.size(), 1u);
  ASSERT_EQ(reading.plan.profile_scanners.size(), 1u);
  const ScannerPlan& vertical = reading.plan.profile_scanners[0];
  EXPECT_EQ(vertical.name, "RLASER");
  EXPECT_EQ(vertical.profile_mounting->position_in_base_m, Eigen::Vector3d(0.4, 0.0, 2.1));
}

TEST_F(CarmenLogTest, HandsOutTheScansOfAVerticalLaserWhereTheyAreAskedFor) {
  CarmenLogOptions options;
  options.reads_profiles = true;
  write_file(file_, kTiltOfTheRearOne + front_and_rear(5));
  const Reading reading = read_with(options);
  EXPECT_EQ(
      std::ranges::count_if(reading.scans,
                            [](const auto& scan) { return scan.scanner.scanner_id == "RLASER"; }),
      5);
  EXPECT_EQ(reading.scans.size(), 10u);
}

TEST_F(CarmenLogTest, RefusesToLocalizeByAVerticalLaser) {
  CarmenLogOptions options;
  options.topics.scanners = {"RLASER"};
  write_file(file_, kTiltOfTheRearOne + front_and_rear(5));
  const auto refused = CarmenLog::open(file_, options);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("RLASER scans a vertical profile"));
  write_file(file_, "PARAM robot_frontlaser_roll_offset 1.57\n" + straight_drive(5));
  const auto only_one = CarmenLog::open(file_, {});
  ASSERT_FALSE(only_one);
  EXPECT_THAT(only_one.error().message, HasSubstr("no scanner scans the plane"));
}

TEST_F(CarmenLogTest, TakesALaserForVerticalThatIsSaidToBe) {
  CarmenLogOptions options;
  options.uses_all_scanners = true;
  options.topics.vertical = {*parse_vertical_scanner("RLASER=1,0,2,0,-90,0")};
  write_file(file_, front_and_rear(5));
  EXPECT_EQ(read_with(options).scans.size(), 5u);
  options.topics.vertical = {*parse_vertical_scanner("LASER7=1,0,2,0,-90,0")};
  const auto refused = CarmenLog::open(file_, options);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("no scanner LASER7"));
}

TEST(VerticalScanner, IsParsedInMetresAndDegrees) {
  const auto scanner = parse_vertical_scanner("/roof/scan=1,-0.5,2.1,90,0,90");
  ASSERT_TRUE(scanner);
  EXPECT_EQ(scanner->name, "/roof/scan");
  EXPECT_EQ(scanner->mounting.position_in_base_m, Eigen::Vector3d(1.0, -0.5, 2.1));
  for (const char* const wrong : {"", "a", "=1,0,2,0,-90,0", "a=1,0,2,0,-90", "a=1,0,2,0,-90,0,1",
                                  "a=1,0,2,0,-90,x", "a=1,0,2,0,nan,0", "a=1,0,2,0,10,0"})
    EXPECT_FALSE(parse_vertical_scanner(wrong)) << wrong;
}

}  // namespace
}  // namespace slammot::files
