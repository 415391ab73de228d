#include "common/files/leg_tracker_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/files/carmen_log.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using testing::write_file;

struct LegTrackerFolder : ::testing::Test {
  LegTrackerFolder() {
    write_file(folder_ / "scan.txt",
               "# bag_time header_stamp angle_min angle_inc n ranges(m)\n"
               "100.5 100.4 -1.0 0.5 5 0 1.5 nan 2.5 inf\n"
               "100.7 100.6 -1.0 0.5 5 0 1.6 nan 2.6 11\n");
    write_file(folder_ / "odom.txt",
               "# stamp x y yaw vx wz\n"
               "100.39 1.0 2.0 0.5 1.0 0.0\n100.45 1.1 2.0 0.5 1.0 0.0\n100.55 1.2 2.0 0.5 1.0 "
               "0.0\n100.65 1.4 2.0 0.5 1.0 0.0\n");
  }
  testing::TemporaryFolder folder_;
};

TEST_F(LegTrackerFolder, IsReadAsALogOfScansWithOdometryAtTheirStamps) {
  auto log = CarmenLog::open(folder_.path());
  ASSERT_TRUE(log) << log.error().message;
  std::vector<sensing::LaserScan> scans;
  std::vector<sensing::Odometry> odometry;
  while (auto event = log->next()) {
    if (auto* scan = std::get_if<sensing::LaserScan>(&*event)) {
      ASSERT_FALSE(odometry.empty());
      EXPECT_EQ(odometry.back().stamp_ns, scan->stamp_ns);
      scans.push_back(*scan);
    } else {
      odometry.push_back(std::get<sensing::Odometry>(*event));
    }
  }
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[0].stamp_ns, 100'500'000'000);  // of the bag
  EXPECT_EQ(scans[0].scanner.first_beam_rad, -1.0);
  EXPECT_NEAR(scans[0].scanner.beam_step_rad, 0.5, 1e-9);
  EXPECT_EQ(scans[1].range_m[3], 2.6F);
  EXPECT_FALSE(sensing::is_echo(scans[0].range_m[0], 11.0));
  EXPECT_FALSE(sensing::is_echo(scans[0].range_m[2], 11.0));
  EXPECT_FALSE(sensing::is_echo(scans[0].range_m[4], 11.0));
  // Between the lines of 100.45 and 100.55.
  const auto at_first_scan =
      std::ranges::find(odometry, 100'500'000'000, &sensing::Odometry::stamp_ns);
  ASSERT_NE(at_first_scan, odometry.end());
  EXPECT_NEAR(at_first_scan->wheel_from_base.x_m, 1.1 + 0.1 * 0.5, 1e-6);
}

TEST_F(LegTrackerFolder, TakesTheLaserToBeWhereTheOptionsSay) {
  CarmenLogOptions options;
  options.fallback_base_from_laser = {0.3, 0.1, 0.7};
  EXPECT_EQ(CarmenLog::open(folder_.path(), options)->plan().base_from_laser,
            options.fallback_base_from_laser);
  auto log = CarmenLog::open(folder_.path());
  log->set_options(options);
  EXPECT_EQ(log->plan().base_from_laser, options.fallback_base_from_laser);
}

TEST_F(LegTrackerFolder, CountsWhatIsMalformed) {
  write_file(folder_ / "scan.txt",
             "100.5 100.4 -1.0 0.5 5 0 1.5 nan 2.5 3\n100.6 100.5 -1.0\n100.7 100.6 x 0.5 5 0 1.5 "
             "nan 2.5 3\n100.8 100.7 -1.0 0.5 5 0 1.5 nan 2.5 3\n");
  auto log = CarmenLog::open(folder_.path());
  ASSERT_TRUE(log);
  std::size_t scans = 0;
  while (const auto event = log->next())
    scans += std::holds_alternative<sensing::LaserScan>(*event) ? 1 : 0;
  EXPECT_EQ(log->faults().malformed_lines, 2U);
  EXPECT_EQ(scans, 2U);
}

TEST_F(LegTrackerFolder, NeedsNoOdometry) {
  std::filesystem::remove(folder_ / "odom.txt");
  const auto log = CarmenLog::open(folder_.path());
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_EQ(log->plan().odometry, OdometrySource::kNone);
  EXPECT_EQ(log->plan().figures.scans, 2U);
}

TEST_F(LegTrackerFolder, IsReadFromItsScanFileAlone) {
  std::filesystem::rename(folder_ / "scan.txt", folder_ / "hall.log");
  const auto log = CarmenLog::open(folder_ / "hall.log");
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_EQ(log->plan().figures.scans, 2U);
}

TEST_F(LegTrackerFolder, IsRefusedWithoutScans) {
  std::filesystem::remove(folder_ / "scan.txt");
  const auto log = CarmenLog::open(folder_.path());
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().message, ::testing::HasSubstr("scan.txt"));
}

}  // namespace
}  // namespace slammot::files
