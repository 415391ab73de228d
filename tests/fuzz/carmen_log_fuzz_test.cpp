#include "common/files/carmen_log.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/fuzz/mutation.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using slammot::testing::mutated;
using slammot::testing::random_bytes;
using slammot::testing::random_words;

const std::vector<std::string_view> kWords = {"FLASER",
                                              "ROBOTLASER1",
                                              "ODOM",
                                              "PARAM",
                                              "RAWLASER1",
                                              "ROBOTLASER2",
                                              "RLASER",
                                              "LASER3",
                                              "TRUEPOS",
                                              "IMU",
                                              "Laser",
                                              "Odometry",
                                              "#",
                                              "0",
                                              "1",
                                              "2",
                                              "4",
                                              "-1",
                                              "181",
                                              "8192",
                                              "8193",
                                              "99999999999",
                                              "1.0",
                                              "1e308",
                                              "1e-320",
                                              "1e999",
                                              "nan",
                                              "-inf",
                                              "0x10",
                                              "3.14159",
                                              "host",
                                              "1575810072.324471",
                                              "9223372036.9",
                                              "robot_frontlaser_offset",
                                              "laser_front_laser_resolution",
                                              "\t",
                                              "\r",
                                              "\0",
                                              "1.2.3",
                                              "--5",
                                              "+7",
                                              ","};

const std::string kRobotLaser =
    "ROBOTLASER1 0 -1.570796 3.141593 1.047198 81.9 0.01 0 4 1.0 2.0 3.0 81.9 2 0.5 0.25 "
    "1.5 0.5 0.1 1.4 0.5 0.1 0 0 0.3 0.2 1000000 1.5 host 1.5\n";

std::string example_log() {
  return "# a log\nPARAM robot_frontlaser_offset 0.3 0 host 0\nODOM 0 0 0 0 0 0 100.0 host 0.0\n" +
         slammot::testing::straight_drive(12) + kRobotLaser + "ODOM 1 0 0 0 0 0 101.1 host 1.1\n";
}

void expect_sound(const LaserRecord& record) {
  EXPECT_GE(record.range_m.size(), 1U);
  EXPECT_LE(record.range_m.size(), kMaxBeams);
  EXPECT_TRUE(std::isfinite(record.max_range_m));
  EXPECT_TRUE(std::isfinite(record.wheel_from_base.x_m + record.wheel_from_base.y_m +
                            record.wheel_from_base.heading_rad));
  if (record.layout)
    EXPECT_TRUE(std::isfinite(record.layout->first_beam_rad) &&
                std::isfinite(record.layout->beam_step_rad));
}

/// How many of the text's lines are laser records.
int parse(const std::string& text) {
  int lasers = 0;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const CarmenRecord record =
        parse_carmen_line(std::string_view(text).substr(begin, end - begin));
    if (const auto* laser = std::get_if<LaserRecord>(&record)) {
      expect_sound(*laser);
      ++lasers;
    }
    begin = end + 1;
  }
  return lasers;
}

TEST(CarmenLineFuzz, SurvivesAnyBytes) {
  std::mt19937 random(1);
  int lasers = 0;
  for (int i = 0; i < 20'000; ++i) lasers += parse(random_bytes(200, random));
  EXPECT_EQ(lasers, 0);
}

TEST(CarmenLineFuzz, SurvivesTheWordsOfALogInAnyOrder) {
  std::mt19937 random(2);
  int lasers = 0;
  for (int i = 0; i < 20'000; ++i) lasers += parse(random_words(kWords, 30, random));
  EXPECT_GT(lasers, 0) << "no record was looked at";
}

TEST(CarmenLineFuzz, SurvivesDamagedLines) {
  std::mt19937 random(3);
  int lasers = 0;
  for (int i = 0; i < 10'000; ++i) lasers += parse(mutated(example_log(), kWords, random));
  EXPECT_GT(lasers, 10'000);
}

class CarmenLogFuzz : public ::testing::Test {
 protected:
  /// Reads the file to its end. What comes must be usable whatever stood there.
  void read_all() {
    auto log = CarmenLog::open(file_);
    if (!log) {
      EXPECT_FALSE(log.error().message.empty());
      EXPECT_EQ(log.error().message.find('\n'), std::string::npos);
      ++refused_;
      return;
    }
    ++opened_;
    std::optional<std::int64_t> odometry_ns;
    std::uint32_t scans = 0;
    while (const auto event = log->next()) {
      ASSERT_LT(scans, 1000U);
      if (const auto* odometry = std::get_if<sensing::Odometry>(&*event)) {
        if (odometry_ns) EXPECT_GT(odometry->stamp_ns, *odometry_ns);
        odometry_ns = odometry->stamp_ns;
        EXPECT_TRUE(std::isfinite(odometry->wheel_from_base.x_m));
      } else {
        const auto& scan = std::get<sensing::LaserScan>(*event);
        EXPECT_EQ(scan.sequence, scans++);
        EXPECT_GE(scan.range_m.size(), 1U);
        EXPECT_LE(scan.range_m.size(), kMaxBeams);
        EXPECT_TRUE(std::isfinite(scan.scanner.max_range_m));
        EXPECT_TRUE(std::isfinite(scan.scanner.beam_step_rad));
        EXPECT_TRUE(std::isfinite(scan.scanner.base_from_laser.x_m));
      }
    }
    EXPECT_LE(log->fraction_read(), 1.0);
  }

  slammot::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "drive.log";
  int opened_ = 0;
  int refused_ = 0;
};

TEST_F(CarmenLogFuzz, ReadsDamagedLogsToTheirEnd) {
  std::mt19937 random(4);
  for (int i = 0; i < 1500; ++i) {
    slammot::testing::write_file(file_, mutated(example_log(), kWords, random));
    read_all();
  }
  EXPECT_GT(opened_, 1000);
}

TEST_F(CarmenLogFuzz, ReadsFilesOfAnyBytesToTheirEnd) {
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    slammot::testing::write_file(file_, random_bytes(3000, random));
    read_all();
    slammot::testing::write_file(file_, random_words(kWords, 400, random));
    read_all();
  }
  EXPECT_GE(refused_, 300) << "files without a scan";
}

TEST_F(CarmenLogFuzz, ReadsDamagedGzipFilesAsFarAsTheyGo) {
  std::mt19937 random(6);
  slammot::testing::write_gz(file_, example_log());
  const std::string compressed = slammot::testing::read_file(file_);
  for (int i = 0; i < 800; ++i) {
    std::string damaged = mutated(compressed, {}, random);
    if (i % 3 == 0) damaged.resize(slammot::testing::below(compressed.size(), random));
    slammot::testing::write_file(file_, damaged);
    read_all();
  }
  EXPECT_GT(opened_, 0);
  EXPECT_GT(refused_, 0);
}

}  // namespace
}  // namespace slammot::files
