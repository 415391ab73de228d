#include "common/files/bag_log.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/files/carmen_log.hpp"
#include "tests/support/bag_bytes.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using geometry::Pose2;
using std::numbers::pi;
using ::testing::HasSubstr;
using testing::MessageSpec;
using testing::PoseNear;
using testing::ScanSpec;
using testing::Wire;
using testing::write_file;

constexpr Wire kWire = Wire::kCdrLittle;
const std::string kScan = "sensor_msgs/LaserScan";

MessageSpec scan(const std::string& topic, const ScanSpec& spec) {
  return {topic, kScan, spec.stamp_s, testing::scan_message(kWire, spec)};
}
MessageSpec fixed(const std::string& child, const std::vector<double>& seven) {
  return {"/tf_static", "tf2_msgs/TFMessage", 100.0,
          testing::transform_message(kWire, 100.0, "base_link", child, seven)};
}

struct Reading {
  std::vector<sensing::Odometry> odometry;
  std::vector<sensing::LaserScan> scans;
  LogPlan plan;
  LogFaults faults;
  TopicChoice topics;
};

class BagLogTest : public ::testing::Test {
 protected:
  Reading read(const std::vector<MessageSpec>& messages, const CarmenLogOptions& options = {}) {
    write_file(file_, testing::mcap_file(messages, "zstd"));
    return read(options);
  }

  Reading read(const CarmenLogOptions& options = {}) {
    Reading reading;
    auto log = CarmenLog::open(file_, options);
    EXPECT_TRUE(log) << (log ? "" : log.error().message);
    if (!log) return reading;
    while (const auto event = log->next()) {
      if (const auto* odometry = std::get_if<sensing::Odometry>(&*event))
        reading.odometry.push_back(*odometry);
      else reading.scans.push_back(std::get<sensing::LaserScan>(*event));
    }
    reading.plan = log->plan();
    reading.faults = log->faults();
    reading.topics = log->topics();
    return reading;
  }

  std::string refusal(const std::vector<MessageSpec>& messages,
                      const CarmenLogOptions& options = {}) {
    write_file(file_, testing::mcap_file(messages, ""));
    const auto log = CarmenLog::open(file_, options);
    EXPECT_FALSE(log);
    return log ? "" : log.error().message;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "drive.mcap";
};

TEST_F(BagLogTest, GivesEachScanRightAfterTheOdometryOfItsStamp) {
  const Reading reading = read(testing::straight_bag(kWire, 10));
  ASSERT_EQ(reading.scans.size(), 10U);
  ASSERT_EQ(reading.odometry.size(), 10U);
  EXPECT_EQ(reading.scans[3].stamp_ns, 100'300'000'000);
  EXPECT_EQ(reading.odometry[3].stamp_ns, 100'300'000'000);
  EXPECT_EQ(reading.odometry[3].wheel_from_base, (Pose2{0.3, 0.5, 0.25}));
  EXPECT_THAT(reading.scans[0].scanner.base_from_laser, PoseNear(Pose2{0.3, 0.0, 0.0}, 1e-12));
  EXPECT_EQ(reading.scans[0].scanner.first_beam_rad, -pi / 2.0);
  EXPECT_EQ(reading.faults.stale_odometry, 0U);
  EXPECT_FALSE(reading.faults.is_cut);
  EXPECT_NEAR(reading.plan.figures.distance_m, 0.9, 1e-9);
}

TEST_F(BagLogTest, TakesTheTurnsOfOdometryFromTheImuWithMostMessages) {
  // Standing, then on the spot: the wheels count 0.6 rad/s, the gyro 0.5; another IMU turns the
  // other way.
  std::vector<MessageSpec> messages = {fixed("laser", {0.3, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0})};
  const auto add_imu = [&](const std::string& topic, double stamp_s, double yaw_rate_radps) {
    std::vector<double> numbers(4 + 9 + 3 + 9 + 3 + 9);
    numbers[4 + 9 + 2] = yaw_rate_radps;
    testing::MessageBytes bytes(kWire);
    messages.push_back(
        {topic, "sensor_msgs/Imu", stamp_s, bytes.header(stamp_s, "imu").numbers(numbers).bytes()});
  };
  for (int i = 0; i < 100; ++i) {
    const double stamp_s = 100.0 + 0.1 * i;
    const double yaw_rate_radps = i < 50 ? 0.0 : 0.5;
    add_imu("/imu/data", stamp_s, yaw_rate_radps);
    add_imu("/imu/data", stamp_s + 0.05, yaw_rate_radps);
    add_imu("/imu/another", stamp_s, -yaw_rate_radps);
    messages.push_back(
        {"/odom", "nav_msgs/Odometry", stamp_s,
         testing::odometry_message(kWire, stamp_s, 0.0, 0.06 * std::max(0, i - 50))});
    messages.push_back(scan("/scan", {.stamp_s = stamp_s}));
  }
  const Reading reading = read(messages);
  ASSERT_EQ(reading.odometry.size(), 100U);
  EXPECT_NEAR(reading.odometry[99].wheel_from_base.heading_rad -
                  reading.odometry[79].wheel_from_base.heading_rad,
              1.0, 0.02);
  EXPECT_THAT(describe(reading.topics), HasSubstr("/imu/another, 100 messages, not used"));
}

TEST_F(BagLogTest, IsTheSameWhereScansAreTooManyToBeKept) {
  CarmenLogOptions keeps_nothing;
  keeps_nothing.most_kept_bytes = 0;
  const Reading kept = read(testing::straight_bag(kWire, 10));
  const Reading again = read(keeps_nothing);
  ASSERT_EQ(kept.scans.size(), again.scans.size());
  for (std::size_t i = 0; i < kept.scans.size(); ++i) {
    EXPECT_EQ(kept.scans[i].stamp_ns, again.scans[i].stamp_ns);
    EXPECT_EQ(kept.scans[i].range_m, again.scans[i].range_m);
    EXPECT_EQ(kept.odometry[i].wheel_from_base, again.odometry[i].wheel_from_base);
  }
}

TEST_F(BagLogTest, InterpolatesOdometryOfOtherStampsAlsoWhereItWasWrittenAfterAllScans) {
  std::vector<MessageSpec> messages;
  for (int i = 0; i < 10; ++i) messages.push_back(scan("/scan", {.stamp_s = 100.05 + i * 0.1}));
  for (int i = 0; i < 11; ++i)
    messages.push_back({"/odom", "nav_msgs/Odometry", 100.0 + i * 0.1,
                        testing::odometry_message(kWire, 100.0 + i * 0.1, i, 0.0)});
  const Reading reading = read(messages);
  ASSERT_EQ(reading.scans.size(), 10U);
  const auto at_scan =
      std::ranges::find(reading.odometry, reading.scans[4].stamp_ns, &sensing::Odometry::stamp_ns);
  ASSERT_NE(at_scan, reading.odometry.end());
  EXPECT_NEAR(at_scan->wheel_from_base.x_m, 4.5, 1e-6);
}

TEST_F(BagLogTest, TakesTheTransformsWhereThereIsNoOdometry) {
  std::vector<MessageSpec> messages = {fixed("laser", {0.3, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0})};
  for (int i = 0; i < 10; ++i) {
    const double stamp_s = 100.0 + i * 0.1;
    messages.push_back({"/tf", "tf2_msgs/TFMessage", stamp_s,
                        testing::transform_message(kWire, stamp_s, "odom", "base_link",
                                                   {i * 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0})});
    messages.push_back(scan("/scan", {.stamp_s = stamp_s}));
  }
  const Reading reading = read(messages);
  EXPECT_NEAR(reading.plan.figures.distance_m, 1.8, 1e-9);
  ASSERT_EQ(reading.topics.odometry.size(), 1U);
  EXPECT_EQ(reading.topics.odometry[0].topic, "/tf");
}

TEST_F(BagLogTest, TurnsTheBeamsOfAScannerThatHangsUpsideDown) {
  const Reading reading =
      read({fixed("laser", {0.3, 0.0, 0.2, 1.0, 0.0, 0.0, 0.0}), scan("/scan", {.first_rad = 0.0F}),
            scan("/scan", {.stamp_s = 1.1, .first_rad = 0.0F})});
  ASSERT_EQ(reading.scans.size(), 2U);
  EXPECT_EQ(reading.scans[0].scanner.beam_step_rad, -pi / 2.0);
  EXPECT_NEAR(reading.scans[0].scanner.base_from_laser.heading_rad, 0.0, 1e-12);
  EXPECT_THAT(describe(reading.topics), HasSubstr("upside down"));
}

std::vector<MessageSpec> two_scanners() {
  std::vector<MessageSpec> messages = {fixed("front", {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}),
                                       fixed("rear", {-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0})};
  for (int i = 0; i < 6; ++i) {
    messages.push_back(
        scan("/front/scan",
             {.stamp_s = 100.0 + i * 0.1, .frame = "front", .range_m = {1.0F, 2.0F, 3.0F, 4.0F}}));
    MessageSpec late = scan("/rear/scan", {.stamp_s = 99.96 + i * 0.1, .frame = "rear"});
    late.log_time_s += 0.05;
    messages.push_back(late);
  }
  return messages;
}

TEST_F(BagLogTest, HandsOutTheScannerThatSeesMostAndNamesTheOther) {
  const Reading reading = read(two_scanners());
  EXPECT_EQ(reading.scans.size(), 6U);
  EXPECT_EQ(reading.scans[0].scanner.scanner_id, "front");
  ASSERT_EQ(reading.topics.scanners.size(), 2U);
  EXPECT_EQ(reading.topics.scanners[0].topic, "/front/scan");
  EXPECT_THAT(describe(reading.topics), HasSubstr("--scan-topic /rear/scan"));
}

TEST_F(BagLogTest, HandsOutAllScannersInTheOrderOfTheirStampsEachWithItsMounting) {
  CarmenLogOptions options;
  options.uses_all_scanners = true;
  const Reading reading = read(two_scanners(), options);
  ASSERT_EQ(reading.scans.size(), 12U);
  for (std::size_t i = 1; i < reading.scans.size(); ++i)
    EXPECT_GT(reading.scans[i].stamp_ns, reading.scans[i - 1].stamp_ns);
  EXPECT_EQ(reading.scans[0].scanner.scanner_id, "rear_scan");
  EXPECT_NEAR(std::abs(reading.scans[0].scanner.base_from_laser.heading_rad), pi, 1e-12);
  EXPECT_EQ(reading.scans[1].scanner.scanner_id, "front_scan");
  EXPECT_EQ(reading.scans[11].sequence, 5U);
}

TEST_F(BagLogTest, TakesTheTopicThatIsAskedFor) {
  CarmenLogOptions options;
  options.topics.scan_topic = "rear/scan";
  const Reading reading = read(two_scanners(), options);
  ASSERT_EQ(reading.scans.size(), 6U);
  EXPECT_EQ(reading.scans[0].range_m.size(), 3U);
}

TEST_F(BagLogTest, TakesTopicsOfOneFrameForOneScanner) {
  std::vector<MessageSpec> messages;
  for (int i = 0; i < 6; ++i) {
    messages.push_back(scan("/scan", {.stamp_s = 100.0 + i * 0.1}));
    messages.push_back(scan("/scan_filtered", {.stamp_s = 100.0 + i * 0.1}));
  }
  CarmenLogOptions options;
  options.uses_all_scanners = true;
  EXPECT_EQ(read(messages, options).scans.size(), 6U);
}

TEST_F(BagLogTest, PrefersOdometryThatIsNotTheTruth) {
  std::vector<MessageSpec> messages = testing::straight_bag(kWire, 10);
  for (int i = 0; i < 20; ++i)
    messages.push_back({"/ground_truth/odom", "nav_msgs/Odometry", 100.0 + i * 0.05,
                        testing::odometry_message(kWire, 100.0 + i * 0.05, 7.0 + i, 0.0)});
  const Reading reading = read(messages);
  EXPECT_NEAR(reading.odometry.front().wheel_from_base.x_m, 0.0, 1e-9);
  CarmenLogOptions options;
  options.topics.odometry_topic = "none";
  EXPECT_TRUE(read(messages, options).odometry.empty());
}

/// A ring of points around a sensor that is 1 m above the base, at the sensor's own height; and one
/// of the ground.
std::string ring_and_ground(double stamp_s, float ring_m) {
  constexpr std::uint32_t kPoints = 2000;
  testing::MessageBytes bytes(kWire);
  bytes.header(stamp_s, "velodyne").add(std::uint32_t{1}).add(kPoints).add(std::uint32_t{3});
  for (std::uint32_t i = 0; i < 3; ++i)
    bytes.text(std::string(1, static_cast<char>('x' + i)))
        .add(4 * i)
        .add(std::uint8_t{7})
        .add(std::uint32_t{1});
  bytes.add(std::uint8_t{0}).add(std::uint32_t{12}).add(12 * kPoints).add(12 * kPoints);
  std::string content = bytes.bytes();
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const float angle_rad =
        static_cast<float>(i / 2) * 2.0F * static_cast<float>(pi) / (kPoints / 2);
    const bool is_ground = i % 2 == 1;
    const float range_m = is_ground ? 0.5F * ring_m : ring_m;
    for (const float value :
         {range_m * std::cos(angle_rad), range_m * std::sin(angle_rad), is_ground ? -1.0F : 0.0F})
      content += testing::raw(value);
  }
  return content + '\1';
}

TEST_F(BagLogTest, CutsCloudsAtTheHeightOfTheSensorOrAtThatWhichIsAskedFor) {
  std::vector<MessageSpec> messages = {fixed("velodyne", {0.4, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0})};
  for (int i = 0; i < 5; ++i)
    messages.push_back({"/points", "sensor_msgs/PointCloud2", 100.0 + i * 0.1,
                        ring_and_ground(100.0 + i * 0.1, 8.0F)});
  const Reading reading = read(messages);
  ASSERT_EQ(reading.scans.size(), 5U);
  EXPECT_EQ(reading.scans[2].stamp_ns, 100'200'000'000);
  EXPECT_THAT(reading.scans[0].scanner.base_from_laser, PoseNear(Pose2{0.4, 0.0, 0.0}, 1e-12));
  EXPECT_THAT(reading.scans[0].range_m, ::testing::Each(::testing::FloatNear(8.0F, 1e-4F)));
  CarmenLogOptions options;
  options.topics.cloud_from_m = -0.1;
  options.topics.cloud_to_m = 0.1;
  const Reading ground = read(messages, options);
  ASSERT_EQ(ground.scans.size(), 5U);
  EXPECT_THAT(ground.scans[0].range_m, ::testing::Each(::testing::FloatNear(4.0F, 1e-4F)));
}

TEST_F(BagLogTest, TakesTheOdometryBeforeAScanWhereNoClockRuns) {
  std::vector<MessageSpec> messages;
  for (int i = 0; i < 10; ++i) {
    messages.push_back(
        {"/odom", "nav_msgs/Odometry", 0.0, testing::odometry_message(kWire, 0.0, i, 0.0)});
    messages.push_back({"/scan", kScan, 0.0, testing::scan_message(kWire, {.stamp_s = 0.0})});
  }
  const Reading reading = read(messages);
  EXPECT_EQ(reading.plan.clock, LogClock::kNominal);
  ASSERT_EQ(reading.odometry.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_EQ(reading.odometry[i].wheel_from_base.x_m, static_cast<double>(i));
}

TEST_F(BagLogTest, LeavesScansThatComeLateByTheirStampWhereTheBagHasThem) {
  std::vector<MessageSpec> messages;
  for (const double stamp_s : {100.001, 100.102, 100.304, 100.203, 100.401, 100.503, 100.602,
                               100.704, 100.801, 100.902, 101.003})
    messages.push_back(scan("/scan", {.stamp_s = stamp_s}));
  const Reading reading = read(messages);
  ASSERT_EQ(reading.scans.size(), 11U);
  EXPECT_EQ(reading.scans[3].stamp_ns, 100'203'000'000);
}

TEST_F(BagLogTest, SaysWhichTopicsThereAreWhereNoneHoldsScans) {
  EXPECT_THAT(refusal({{"/odom", "nav_msgs/Odometry", 1.0,
                        testing::odometry_message(kWire, 1.0, 0.0, 0.0)}}),
              HasSubstr("/odom (nav_msgs/Odometry)"));
  CarmenLogOptions options;
  options.topics.scan_topic = "/other";
  EXPECT_THAT(refusal(testing::straight_bag(kWire, 3), options),
              HasSubstr("no laser scan of the topic /other"));
  options.topics = {.odometry_topic = "/other"};
  EXPECT_THAT(refusal(testing::straight_bag(kWire, 3), options),
              HasSubstr("no odometry of the topic /other"));
}

TEST_F(BagLogTest, SaysWhichMessagesAreLeftOutAndWhy) {
  std::vector<MessageSpec> messages = testing::straight_bag(kWire, 10);
  for (MessageSpec& message : messages) {
    if (message.topic != "/odom") continue;
    testing::MessageBytes bytes(kWire);
    bytes.header(message.log_time_s, "odom").text("base_link").numbers(std::vector<double>(7));
    message.bytes = bytes.numbers(std::vector<double>(36 + 6 + 36)).bytes();
  }
  const Reading reading = read(messages);
  EXPECT_TRUE(reading.odometry.empty());
  EXPECT_THAT(reading.topics.doubts,
              ::testing::ElementsAre(
                  "/odom: 10 messages are left out; the first: its quaternion is all zeros"));
}

TEST_F(BagLogTest, DoubtsAStepThatContradictsTheEndsOfTheScan) {
  std::vector<MessageSpec> messages = testing::straight_bag(kWire, 10);
  for (MessageSpec& message : messages) {
    if (message.topic != "/scan") continue;
    const std::string step = testing::raw(ScanSpec().step_rad);
    // angle_min, angle_max and angle_increment follow each other; both ends have the step's size.
    const std::size_t at = message.bytes.rfind(step);
    message.bytes.replace(at, step.size(), testing::raw(-ScanSpec().step_rad));
  }
  const Reading reading = read(messages);
  ASSERT_EQ(reading.scans.size(), 10U);
  EXPECT_EQ(reading.scans[0].scanner.beam_step_rad, pi / 2.0);
  ASSERT_EQ(reading.topics.doubts.size(), 1U);
  EXPECT_THAT(reading.topics.doubts[0], HasSubstr("/scan: the sign of angle_increment"));
}

TEST_F(BagLogTest, SaysWhyScansCannotBeUsed) {
  EXPECT_THAT(refusal({scan("/scan", {.first_rad = -90.0F, .step_rad = 90.0F})}),
              HasSubstr("no usable laser scan: /scan: 1 messages, the first: its angles are "
                        "impossible, perhaps degrees (angle_min -90, angle_max 90, "
                        "angle_increment 90 rad, 3 ranges)"));
  EXPECT_THAT(refusal({scan("/scan", {.step_rad = NAN})}), HasSubstr("angle_increment nan rad"));
}

TEST_F(BagLogTest, NamesAScannerWithoutAFrame) {
  std::vector<MessageSpec> messages;
  for (int i = 0; i < 5; ++i)
    messages.push_back(scan("/scan", {.stamp_s = 100.0 + i * 0.1, .frame = ""}));
  EXPECT_THAT(describe(read(messages).topics),
              HasSubstr("where the scanner (frame_id is empty) is on the vehicle"));
}

TEST_F(BagLogTest, UsesWhatComesBeforeACut) {
  const std::string whole = testing::mcap_file(testing::straight_bag(kWire, 40), "");
  write_file(file_, whole.substr(0, whole.size() / 2));
  const Reading reading = read();
  EXPECT_TRUE(reading.faults.is_cut);
  EXPECT_THAT(reading.faults.damage, HasSubstr("ends in the record at byte"));
  EXPECT_GT(reading.scans.size(), 15U);
}

TEST_F(BagLogTest, CorrectsTheClockOfOdometryByTheTimesOfRecording) {
  for (const double ahead_s : {5.0, -3600.0, 0.2}) {
    std::vector<MessageSpec> messages;
    for (int i = 0; i < 40; ++i) {
      const double time_s = 10000.0 + i * 0.1;
      messages.push_back({"/odom", "nav_msgs/Odometry", time_s + 0.02,
                          testing::odometry_message(kWire, time_s + ahead_s, 0.1 * i, 0.0)});
      messages.push_back(
          {"/scan", kScan, time_s + 0.02, testing::scan_message(kWire, {.stamp_s = time_s})});
    }
    const Reading reading = read(messages);
    const bool is_corrected = ahead_s != 0.2;  // as long as a message may be on its way
    EXPECT_EQ(reading.topics.doubts.size(), is_corrected ? 1U : 0U) << ahead_s;
    if (!is_corrected) continue;
    EXPECT_THAT(reading.topics.doubts.front(),
                HasSubstr(ahead_s > 0.0 ? "s ahead of" : "s behind"));
    ASSERT_EQ(reading.odometry.size(), 40U) << ahead_s;
    EXPECT_NEAR(1e-9 * static_cast<double>(reading.odometry[20].stamp_ns), 10002.0, 0.02);
    EXPECT_NEAR(reading.odometry[20].wheel_from_base.x_m, 2.0, 0.01);
  }
}

TEST_F(BagLogTest, TakesTheTimeOfRecordingWhereHeadersHaveNone) {
  std::vector<MessageSpec> messages;
  for (int i = 0; i < 10; ++i) {
    const double time_s = 100.0 + i * 0.1;
    messages.push_back(
        {"/odom", "nav_msgs/Odometry", time_s, testing::odometry_message(kWire, 0.0, i, 0.0)});
    messages.push_back({"/scan", kScan, time_s, testing::scan_message(kWire, {.stamp_s = 0.0})});
  }
  const Reading reading = read(messages);
  ASSERT_EQ(reading.scans.size(), 10U);
  EXPECT_EQ(reading.plan.clock, LogClock::kLogger);
  EXPECT_EQ(reading.scans[9].stamp_ns, 100'900'000'000);
  EXPECT_NEAR(reading.plan.figures.distance_m, 9.0, 1e-9);
}

}  // namespace
}  // namespace slammot::files
