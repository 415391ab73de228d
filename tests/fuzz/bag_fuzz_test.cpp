#include "common/files/bag_log.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "common/bags/bag.hpp"
#include "common/bags/ros_messages.hpp"
#include "common/files/carmen_log.hpp"
#include "tests/fuzz/mutation.hpp"
#include "tests/support/bag_bytes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using slammot::testing::below;
using slammot::testing::mutated;
using slammot::testing::random_bytes;
using slammot::testing::Wire;

/// Numbers and names at which readers of bags are apt to stumble.
const std::vector<std::string_view> kWords = {
    std::string_view("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 8),
    std::string_view("\xFF\xFF\xFF\x7F", 4),
    std::string_view("\0\0\0\0", 4),
    std::string_view("\0\0\0\x80", 4),
    std::string_view("\x00\x00\xC0\x7F", 4),
    std::string_view("\x00\x00\x80\x7F", 4),
    "\x01",
    "\x02",
    "\x03",
    "\x04",
    "\x05",
    "\x06",
    "\x0F",
    "op=",
    "conn=",
    "size=",
    "none",
    "lz4",
    "bz2",
    "zstd",
    "cdr",
    "/scan",
    "/odom",
    "base_link",
    "laser",
    "sensor_msgs/LaserScan",
    "sensor_msgs/PointCloud2",
    "nav_msgs/Odometry",
    "tf2_msgs/TFMessage"};

class BagFuzz : public ::testing::Test {
 protected:
  /// Reads the file to its end. What comes must be usable whatever stood there.
  void read_all(const std::string& name, std::size_t most_kept_bytes) {
    CarmenLogOptions options;
    options.most_kept_bytes = most_kept_bytes;
    options.uses_all_scanners = true;
    auto log = CarmenLog::open(folder_ / name, options);
    if (!log) {
      EXPECT_FALSE(log.error().message.empty());
      EXPECT_EQ(log.error().message.find('\n'), std::string::npos);
      ++refused_;
      return;
    }
    ++opened_;
    std::size_t scans = 0;
    std::optional<std::int64_t> odometry_ns;
    while (const auto event = log->next()) {
      if (const auto* odometry = std::get_if<sensing::Odometry>(&*event)) {
        if (odometry_ns) EXPECT_GT(odometry->stamp_ns, *odometry_ns);
        odometry_ns = odometry->stamp_ns;
        EXPECT_TRUE(std::isfinite(odometry->wheel_from_base.x_m + odometry->wheel_from_base.y_m +
                                  odometry->wheel_from_base.heading_rad));
        continue;
      }
      ASSERT_LT(++scans, 1000U);
      const auto& scan = std::get<sensing::LaserScan>(*event);
      EXPECT_GE(scan.range_m.size(), 2U);
      EXPECT_LE(scan.range_m.size(), kMaxBeams);
      EXPECT_TRUE(std::isfinite(scan.scanner.max_range_m));
      EXPECT_TRUE(std::isfinite(scan.scanner.first_beam_rad + scan.scanner.beam_step_rad));
      EXPECT_TRUE(std::isfinite(scan.scanner.base_from_laser.x_m +
                                scan.scanner.base_from_laser.heading_rad));
      EXPECT_LE(scan.scanner.scanner_id.size(), 31U);
    }
    EXPECT_LE(log->fraction_read(), 1.0);
  }

  void read_damaged(const std::string& name, const std::string& whole, int times, unsigned seed) {
    std::mt19937 random(seed);
    opened_ = refused_ = 0;
    for (int i = 0; i < times; ++i) {
      std::string damaged = i % 3 == 0 ? mutated(whole, kWords, random) : whole;
      // most others are refused at once
      if (i % 3 != 0)
        damaged[below(damaged.size(), random)] ^= static_cast<char>(1 << below(8, random));
      if (i % 4 == 0) damaged.resize(below(damaged.size() + 1, random));
      slammot::testing::write_file(folder_ / name, damaged);
      read_all(name, i % 2 == 0 ? 0 : std::size_t{1} << 20);
    }
    EXPECT_GT(opened_, times / 20) << name << ": hardly anything of it was looked at";
    EXPECT_GT(refused_, 0) << name;
  }

  slammot::testing::TemporaryFolder folder_;
  int opened_ = 0;
  int refused_ = 0;
};

TEST_F(BagFuzz, ReadsDamagedMcapFilesToTheirEnd) {
  unsigned seed = 1;
  for (const char* compression : {"no chunks", "", "lz4", "zstd"})
    read_damaged("drive.mcap",
                 slammot::testing::mcap_file(slammot::testing::straight_bag(Wire::kCdrLittle, 6),
                                             compression),
                 400, seed++);
}

TEST_F(BagFuzz, ReadsDamagedBagsOfRos1ToTheirEnd) {
  unsigned seed = 11;
  for (const char* compression : {"none", "lz4", "bz2"})
    read_damaged(
        "drive.bag",
        slammot::testing::ros1_file(slammot::testing::straight_bag(Wire::kRos1, 6), compression),
        400, seed++);
}

TEST_F(BagFuzz, ReadsDamagedDatabasesToTheirEnd) {
  slammot::testing::write_db3(folder_ / "whole.db3",
                              slammot::testing::straight_bag(Wire::kCdrBig, 6));
  const std::string whole = slammot::testing::read_file(folder_ / "whole.db3");
  read_damaged("drive.db3", whole, 400, 21);
  read_damaged("drive.db3.zstd", slammot::testing::packed("zstd", whole), 200, 22);
}

TEST_F(BagFuzz, ReadsFilesThatOnlyBeginAsBagsDo) {
  std::mt19937 random(31);
  for (int i = 0; i < 600; ++i) {
    const std::string begin = i % 3 == 0   ? std::string("\x89MCAP0\r\n", 8)
                              : i % 3 == 1 ? "#ROSBAG V2.0\n"
                                           : std::string("SQLite format 3\0", 16);
    slammot::testing::write_file(folder_ / "drive", begin + random_bytes(2000, random));
    read_all("drive", 0);
  }
}

/// Each parser of a message, whatever the type says.
void parse_all(const std::string& bytes, bags::Serialization serialization) {
  for (const char* type : {"sensor_msgs/LaserScan", "sensor_msgs/MultiEchoLaserScan"}) {
    const bags::Channel channel{"/t", type, "", serialization};
    const bags::RawMessage message{
        &channel, 0, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}};
    if (const auto scan = bags::parse_laser_scan(message)) {
      EXPECT_LE(scan->range_m.size(), bytes.size());
      if (const auto record = record_of(*scan))
        EXPECT_TRUE(std::isfinite(record->layout->first_beam_rad + record->layout->beam_step_rad));
    }
    if (const auto odometry = bags::parse_odometry(message))
      EXPECT_TRUE(odometry->pose.translation_m.allFinite());
    if (const auto transforms = bags::parse_transforms(message))
      EXPECT_LE(transforms->size(), bytes.size());
    if (const auto imu = bags::parse_imu(message)) EXPECT_TRUE(std::isfinite(imu->yaw_rate_radps));
    if (const auto cloud = bags::parse_point_cloud(message))
      EXPECT_LE(cloud->points_m.size(), bytes.size());
  }
}

TEST(MessageFuzz, SurvivesAnyBytesAndDamagedMessages) {
  std::mt19937 random(41);
  for (const Wire wire : {Wire::kRos1, Wire::kCdrLittle, Wire::kCdrBig}) {
    const auto serialization =
        wire == Wire::kRos1 ? bags::Serialization::kRos1 : bags::Serialization::kCdr;
    for (int i = 0; i < 3000; ++i) {
      parse_all(random_bytes(300, random), serialization);
      parse_all(mutated(slammot::testing::scan_message(wire, {}), kWords, random), serialization);
      parse_all(mutated(slammot::testing::odometry_message(wire, 1.0, 2.0, 0.5), kWords, random),
                serialization);
      parse_all(
          mutated(slammot::testing::transform_message(wire, 1.0, "a", "b", {1, 2, 3, 0, 0, 0, 1}),
                  kWords, random),
          serialization);
    }
  }
}

}  // namespace
}  // namespace slammot::files
