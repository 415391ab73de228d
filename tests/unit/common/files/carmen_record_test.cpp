#include "common/files/carmen_record.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::files {
namespace {

using geometry::Pose2;
using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::PoseNear;

const std::string kHead = "ROBOTLASER1 0 -1.570796 3.141593 0.785398 81.83 0.01 0 5 1 2 3 4 81.83 ";
const std::string kTail = "3 4 1.570796 3 2 1.570796 0.5 0.1 1 1 0 12.345678 host 7.5";

bool is_malformed(const std::string& line) {
  return std::holds_alternative<MalformedLine>(parse_carmen_line(line));
}
LaserRecord laser(const std::string& line) {
  return std::get<LaserRecord>(parse_carmen_line(line));
}

/// What std::from_chars makes of it, which rounds correctly.
float correctly_rounded(const std::string& text) {
  float value = 0.0F;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

TEST(ParseReading, RoundsEveryReadingCorrectlyHoweverItIsWritten) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> digit('0', '9');
  for (int i = 0; i < 50'000; ++i) {
    std::string reading(1 + i % 5, '0');
    if (i % 7 != 0) reading += "." + std::string(static_cast<std::size_t>(i / 5 % 7), '0');
    for (char& c : reading) c = c == '.' ? c : static_cast<char>(digit(random));
    ASSERT_EQ(laser("FLASER 2 " + reading + " 5 3 4 1.5 3 4 1.5 12.5 host 7.5").range_m.front(),
              correctly_rounded(reading))
        << reading;
  }
  for (const std::string reading : {"16777216", "16777217", "99999999", "9999999", "0.0000001",
                                    "1.", "007.50", "81.83", "8.183e1", "-1.5", "0"}) {
    EXPECT_EQ(laser("FLASER 2 " + reading + " 5 3 4 1.5 3 4 1.5 12.5 host 7.5").range_m.front(),
              correctly_rounded(reading))
        << reading;
  }
}

TEST(ParseReading, RefusesWhatIsNoNumber) {
  for (const char* text : {".", "1.2.3", "12x", "1..", "--1", "1,5"})
    EXPECT_TRUE(is_malformed(std::string("FLASER 2 ") + text + " 5 3 4 1.5 3 4 1.5 12.5 host 7.5"))
        << text;
}

TEST(ParseStamp, KeepsEveryDigitThatADoubleWouldLose) {
  EXPECT_EQ(parse_stamp_ns("1575810072.324471"), 1'575'810'072'324'471'000);
  EXPECT_EQ(parse_stamp_ns("21.0199"), 21'019'900'000);
  EXPECT_EQ(parse_stamp_ns("0.000246"), 246'000);
  EXPECT_EQ(parse_stamp_ns("17"), 17'000'000'000);
  EXPECT_EQ(parse_stamp_ns(".5"), 500'000'000);
  EXPECT_EQ(parse_stamp_ns("-1.25"), -1'250'000'000);
  EXPECT_EQ(parse_stamp_ns("1.1234567899"), 1'123'456'789);
  EXPECT_EQ(parse_stamp_ns("1.5e3"), 1'500'000'000'000);
  for (const char* text : {"1575810072324", "1575810072324000", "1575810072324000000"})
    EXPECT_EQ(parse_stamp_ns(text), 1'575'810'072'324'000'000) << text;
}

TEST(ParseStamp, RefusesWhatIsNoTime) {
  for (const char* text :
       {"", "-", "nan", "inf", "abc", "12x", "1e40", "99999999999999999999", "1.2.3", "0x10"}) {
    EXPECT_EQ(parse_stamp_ns(text), std::nullopt) << text;
  }
}

TEST(ParseCarmenLine, ReadsFlaserWithTheWheelsPoseAndBothClocks) {
  const auto record = laser("FLASER 3 1.5 2.5 81.83 9 9 9 1.0 2.0 0.5 12.25 host 3.5");
  EXPECT_EQ(record.kind, LaserRecordKind::kFlaser);
  EXPECT_THAT(record.range_m, ElementsAre(1.5F, 2.5F, 81.83F));
  EXPECT_THAT(record.wheel_from_base, PoseNear(Pose2{1.0, 2.0, 0.5}, 1e-12));
  EXPECT_FALSE(record.layout);
  EXPECT_EQ(record.max_range_m, 0.0);
  EXPECT_EQ(record.stamps.ipc_ns, 12'250'000'000);
  EXPECT_EQ(record.stamps.logger_ns, 3'500'000'000);
}

TEST(ParseCarmenLine, RefusesFlaserWithAnotherCountThanItSays) {
  const std::string rest = " 1.5 2.5 81.83 9 9 9 1.0 2.0 0.5 12.25 host 3.5";
  for (const char* count : {"2", "4"}) {
    const CarmenRecord record = parse_carmen_line("FLASER " + std::string(count) + rest);
    ASSERT_TRUE(std::holds_alternative<MalformedLine>(record)) << count;
    EXPECT_THAT(std::string(std::get<MalformedLine>(record).why), HasSubstr("as many ranges"))
        << count;
  }
  for (const char* end : {"12.25 7 3.5", "12.25 host", "12.25", "nan host 3.5",
                          "12.25 host 3.5 more", "12.25 192.168.0.1 3.5"})
    EXPECT_FALSE(is_malformed(std::string("FLASER 2 1 2 9 9 9 1 2 0.5 ") + end)) << end;
}

TEST(ParseCarmenLine, ReadsRobotLaserWithoutRemissionCount) {
  const auto record = laser(kHead + kTail);
  EXPECT_THAT(record.range_m, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F, 81.83F));
  EXPECT_THAT(record.wheel_from_base, PoseNear(Pose2{3.0, 2.0, pi / 2.0}, 1e-6));
  ASSERT_TRUE(record.base_from_laser);
  EXPECT_THAT(*record.base_from_laser, PoseNear(Pose2{2.0, 0.0, 0.0}, 1e-5));
  ASSERT_TRUE(record.layout);
  EXPECT_NEAR(record.layout->first_beam_rad, -pi / 2.0, 1e-6);
  EXPECT_NEAR(record.layout->beam_step_rad, pi / 4.0, 1e-6);
  EXPECT_EQ(record.stamps.ipc_ns, 12'345'678'000);
}

TEST(ParseCarmenLine, ReadsTheSameWithRemissionsOrWithACountOfNone) {
  for (const char* remissions : {"0 ", "5 10 20 30 40 50 ", "2 0.5 0.25 "}) {
    const auto record = laser(kHead + remissions + kTail);
    EXPECT_THAT(record.wheel_from_base, PoseNear(Pose2{3.0, 2.0, pi / 2.0}, 1e-6)) << remissions;
    EXPECT_EQ(record.stamps.ipc_ns, 12'345'678'000) << remissions;
  }
}

TEST(ParseCarmenLine, ComparesAReadingOfTheMaximumRangeAsNoEcho) {
  const auto record = laser(kHead + kTail);
  EXPECT_FALSE(static_cast<double>(record.range_m.back()) < record.max_range_m);
}

TEST(ParseCarmenLine, TakesTheStepThatFieldAndBeamCountAgreeOn) {
  const std::string tail = " 1 2 3 4 " + kTail;
  const auto step = [&](const std::string& field, const std::string& recorded_step) {
    return laser("ROBOTLASER1 0 -3.1 " + field + " " + recorded_step + " 30 0 0 4" + tail)
        .layout->beam_step_rad;
  };
  EXPECT_NEAR(step("3.0", "1.0"), 1.0, 1e-12);              // both ends are in
  EXPECT_NEAR(step("6.283185", "1.5708"), pi / 2.0, 1e-6);  // full circle, the first beam is not
                                                            // repeated
  EXPECT_NEAR(step("3.0", "0"), 1.0, 1e-12);                // not said
  EXPECT_NEAR(step("3.0", "0.1"), 0.1, 1e-12);              // part of the field
}

TEST(ParseCarmenLine, LeavesTheLayoutToConventionWhereTheRecordMakesNoSense) {
  const std::string tail = " 81.83 0.01 0 5 1 2 3 4 5 " + kTail;
  EXPECT_FALSE(laser("ROBOTLASER1 0 -90 180 1" + tail).layout);
  EXPECT_FALSE(laser("ROBOTLASER1 0 0 0 0" + tail).layout);
}

TEST(ParseCarmenLine, ReadsOdomAndParam) {
  const auto odom =
      std::get<OdometryRecord>(parse_carmen_line("ODOM 1 2 0.5 0.3 0 0 12.5 host 3.5"));
  EXPECT_THAT(odom.wheel_from_base, PoseNear(Pose2{1.0, 2.0, 0.5}, 1e-12));
  EXPECT_EQ(odom.stamps.ipc_ns, 12'500'000'000);
  const auto line = std::string("PARAM robot_frontlaser_offset 2.15  12.0 host 0.1");
  const auto param = std::get<ParamRecord>(parse_carmen_line(line));
  EXPECT_EQ(param.name, "robot_frontlaser_offset");
  EXPECT_EQ(param.value, "2.15");
}

TEST(ParseCarmenLine, IgnoresCommentsAndOtherMessages) {
  for (const char* line : {"", "   ", "# CARMEN Logfile", "SYNC begin 1 h 1", "NMEARMC 1 2 3",
                           "ROBOTLASER 2 1 1", "ROBOTLASER0 2 1 1", "\x01\x02\xff"}) {
    EXPECT_TRUE(std::holds_alternative<IgnoredLine>(parse_carmen_line(line))) << line;
  }
}

TEST(ParseCarmenLine, KnowsTheRearLaserByItsSlot) {
  const LaserRecord record = laser("RLASER 2 1 2 3 4 1.5 5 6 0.5 12.5 host 7.5");
  EXPECT_EQ(record.kind, LaserRecordKind::kFlaser);
  EXPECT_EQ(record.slot, 2);
  EXPECT_EQ(record.scanner, "RLASER");
  EXPECT_THAT(record.wheel_from_base, PoseNear(Pose2{5.0, 6.0, 0.5}, 1e-12));
}

TEST(ParseCarmenLine, NumbersRobotAndRawLasers) {
  const LaserRecord robot =
      laser("ROBOTLASER2" + kHead.substr(std::string("ROBOTLASER1").size()) + kTail);
  EXPECT_EQ(robot.slot, 2);
  EXPECT_EQ(robot.scanner, "ROBOTLASER2");
  const LaserRecord raw = laser(
      "RAWLASER3 0 -1.570796 3.141593 0.785398 81.83 0.01 0 5 1 2 3 4 5 2 0.5 0.6 12.5 host 7.5");
  EXPECT_EQ(raw.kind, LaserRecordKind::kRawLaser);
  EXPECT_EQ(raw.slot, 3);
  EXPECT_THAT(raw.range_m, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F, 5.0F));
  EXPECT_EQ(raw.stamps.ipc_ns, 12'500'000'000);
  ASSERT_TRUE(raw.layout);
  EXPECT_NEAR(raw.layout->beam_step_rad, pi / 4.0, 1e-6);
  const LaserRecord old = laser("LASER4 2 1 2 12.5 host 7.5");
  EXPECT_EQ(old.slot, 4);
  EXPECT_FALSE(old.layout);
}

TEST(ParseCarmenLine, TakesOdometryFromTheSecondPoseOfTruePos) {
  const auto record =
      std::get<OdometryRecord>(parse_carmen_line("TRUEPOS 1 2 0.1 3 4 0.2 12.5 host 7.5"));
  EXPECT_EQ(record.kind, OdometryRecordKind::kTruePos);
  EXPECT_THAT(record.wheel_from_base, PoseNear(Pose2{3.0, 4.0, 0.2}, 1e-12));
  EXPECT_EQ(record.stamps.ipc_ns, 12'500'000'000);
}

TEST(ParseCarmenLine, TakesTheYawRateOfAnImu) {
  const auto record = std::get<ImuRecord>(
      parse_carmen_line("IMU 0 0 9.81 1 0 0 0 1 2 3 0.1 0.2 0.3 12.5 host 7.5"));
  EXPECT_EQ(record.yaw_rate_radps, 0.3);
  EXPECT_EQ(record.stamps.ipc_ns, 12'500'000'000);
}

TEST(ParseCarmenLine, ReadsAFixOfASatelliteReceiver) {
  const auto record = std::get<GnssRecord>(parse_carmen_line(
      "NMEAGGA 1 120000.0 4026.436000 N 7959.754000 W 1 9 1.20 0 231.5 0 0 0 12.5 host 7.5"));
  EXPECT_EQ(record.fix.quality, sensing::GnssQuality::single);
  EXPECT_NEAR(record.fix.position.latitude_deg, 40.4406, 1e-9);
  EXPECT_NEAR(record.fix.position.longitude_deg, -79.9959, 1e-9);
  EXPECT_EQ(record.fix.satellites, 9);
  EXPECT_EQ(record.fix.altitude_m, 231.5);
  EXPECT_GT(record.fix.covariance_m2(0, 0), 0.5);
  EXPECT_EQ(record.stamps.ipc_ns, 12'500'000'000);
}

TEST(ParseCarmenLine, ReadsAHeadingAgainstTrueNorthAsOneFromEast) {
  const auto record = std::get<CompassRecord>(parse_carmen_line("NMEAHDT 1 30.0 1 12.5 host 7.5"));
  EXPECT_NEAR(record.reading.heading_from_east_rad, pi / 3.0, 1e-9);
  EXPECT_GT(record.reading.sigma_rad, 0.0);
  EXPECT_TRUE(
      std::holds_alternative<IgnoredLine>(parse_carmen_line("NMEAHDT 1 30.0 0 12.5 host 7.5")));
}

TEST(ParseCarmenLine, RefusesFixesAndHeadingsThatCannotBe) {
  EXPECT_TRUE(is_malformed("NMEAGGA 1 0 9126.4 N 7959.7 W 1 9 1.2 0 231.5 0 0 0 12.5 host 7.5"));
  EXPECT_TRUE(is_malformed("NMEAGGA 1 0 4026.4 X 7959.7 W 1 9 1.2 0 231.5 0 0 0 12.5 host 7.5"));
  EXPECT_TRUE(is_malformed("NMEAGGA 1 0 nan N 7959.7 W 1 9 1.2 0 231.5 0 0 0 12.5 host 7.5"));
  EXPECT_TRUE(is_malformed("NMEAGGA 1 0 4026.4 N"));
  EXPECT_TRUE(is_malformed("NMEAHDT 1 720 1 12.5 host 7.5"));
  EXPECT_TRUE(is_malformed("NMEAHDT 1"));
}

TEST(ParseCarmenLine, ReadsLinesOfDpSlamWithoutStamps) {
  const LaserRecord record = laser("Laser 3 1.5 2.5 3.5");
  EXPECT_EQ(record.kind, LaserRecordKind::kDpSlam);
  EXPECT_THAT(record.range_m, ElementsAre(1.5F, 2.5F, 3.5F));
  EXPECT_FALSE(record.stamps.ipc_ns);
  EXPECT_THAT(std::get<OdometryRecord>(parse_carmen_line("Odometry 1 2 0.5")).wheel_from_base,
              PoseNear(Pose2{1.0, 2.0, 0.5}, 1e-12));
  EXPECT_TRUE(is_malformed("Laser 3 1.5 2.5"));
  EXPECT_TRUE(is_malformed("Odometry 1 2"));
}

TEST(ParseCarmenLine, RefusesTooFewNumbersAndPosesThatCannotBe) {
  EXPECT_TRUE(is_malformed("FLASER"));
  EXPECT_TRUE(is_malformed("FLASER 3 1 2"));
  EXPECT_TRUE(is_malformed("FLASER 3 1 2 3 0 0 0 0 0 0"));
  EXPECT_TRUE(is_malformed("FLASER 0 0 0 0 0 0 0 1 h 1"));
  EXPECT_TRUE(is_malformed("FLASER -3 1 2 3 0 0 0 0 0 0 1 h 1"));
  EXPECT_TRUE(is_malformed("FLASER 99999999999 1 2 3 0 0 0 0 0 0 1 h 1"));
  EXPECT_TRUE(is_malformed("FLASER 3 1 x 3 0 0 0 0 0 0 1 h 1"));
  EXPECT_TRUE(is_malformed("FLASER 3 1 2 3 0 0 0 nan 0 0 1 h 1"));
  EXPECT_TRUE(is_malformed("FLASER 3 1 2 3 0 0 0 0 1e300 0 1 h 1"));
  EXPECT_TRUE(is_malformed(kHead));
  EXPECT_TRUE(is_malformed(kHead + "0 3 4 1.57 3 2 1.57"));
  EXPECT_TRUE(is_malformed("ODOM 1 2"));
  EXPECT_TRUE(is_malformed("ODOM inf 2 0 0 0 0 1 h 1"));
  EXPECT_TRUE(is_malformed("PARAM lonely"));
}

TEST(ParseCarmenLine, KeepsScansWithReadingsThatAreNoRanges) {
  const auto record = laser("FLASER 6 nan -1.5 inf 1e300 1e-300 2 0 0 0 0 0 0 1 h 1");
  EXPECT_TRUE(std::isnan(record.range_m[0]));
  EXPECT_EQ(record.range_m[1], -1.5F);
  EXPECT_TRUE(std::isinf(record.range_m[2]));
  EXPECT_TRUE(std::isnan(record.range_m[3]));
  EXPECT_EQ(record.range_m[5], 2.0F);
}

TEST(ParseCarmenLine, SurvivesEveryCutAndManyChangesOfARecord) {
  const std::string whole = kHead + "2 1 2 " + kTail;
  const auto laser_of = [](const std::string& line) {
    const CarmenRecord record = parse_carmen_line(line);
    const auto* laser = std::get_if<LaserRecord>(&record);
    return laser == nullptr ? std::nullopt : std::optional(*laser);
  };
  ASSERT_TRUE(laser_of(whole));
  EXPECT_FALSE(laser_of(whole.substr(0, kHead.size())));
  for (std::size_t length = 0; length <= whole.size(); ++length)
    if (const auto laser = laser_of(whole.substr(0, length)))
      EXPECT_EQ(laser->range_m, laser_of(whole)->range_m) << length;
  std::mt19937 random(1);
  int lasers = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string changed = whole;
    for (int k = 0; k < 3; ++k)
      changed[random() % changed.size()] = static_cast<char>(random() % 256);
    if (const auto laser = laser_of(changed)) {
      ++lasers;
      EXPECT_LE(laser->range_m.size(), changed.size());
      EXPECT_TRUE(std::isfinite(laser->wheel_from_base.x_m + laser->wheel_from_base.y_m +
                                laser->wheel_from_base.heading_rad))
          << changed;
    }
  }
  EXPECT_GT(lasers, 0);
}

TEST(LayoutByConvention, SpreadsEvenCountsOneStepShortAndOddCountsOverTheWholeField) {
  EXPECT_NEAR(layout_by_convention(180, pi).beam_step_rad, pi / 180.0, 1e-12);
  EXPECT_NEAR(layout_by_convention(181, pi).beam_step_rad, pi / 180.0, 1e-12);
  EXPECT_NEAR(layout_by_convention(360, pi).beam_step_rad, pi / 360.0, 1e-12);
  EXPECT_NEAR(layout_by_convention(361, pi).beam_step_rad, pi / 360.0, 1e-12);
  EXPECT_NEAR(layout_by_convention(361, pi).first_beam_rad, -pi / 2.0, 1e-12);
}

}  // namespace
}  // namespace slammot::files
