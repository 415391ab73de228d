#include "common/bags/ros_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/bag_bytes.hpp"

namespace slammot::bags {
namespace {

using ::testing::ElementsAre;
using testing::MessageBytes;
using testing::Wire;

class RosMessages : public ::testing::TestWithParam<Wire> {
 protected:
  RawMessage message(const std::string& type, const std::string& bytes) {
    channel_.type = type;
    channel_.serialization = GetParam() == Wire::kRos1 ? Serialization::kRos1 : Serialization::kCdr;
    bytes_ = bytes;
    return {&channel_, 0, {reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size()}};
  }
  Channel channel_;
  std::string bytes_;
};

TEST_P(RosMessages, HoldScans) {
  const auto scan = parse_laser_scan(
      message("sensor_msgs/LaserScan",
              testing::scan_message(GetParam(), {.stamp_s = 12.5, .frame = "/front"})));
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->header.stamp_ns, 12'500'000'000);
  EXPECT_EQ(scan->header.frame, "front");
  EXPECT_EQ(scan->most_range_m, 30.0F);
  EXPECT_THAT(scan->range_m, ElementsAre(1.0F, 2.0F, 3.0F));
}

TEST_P(RosMessages, HoldTheFirstEchoOfEachBeam) {
  MessageBytes bytes(GetParam());
  bytes.header(1.0, "laser")
      .add(0.0F)
      .add(1.0F)
      .add(0.5F)
      .add(0.0F)
      .add(0.0F)
      .add(0.1F)
      .add(30.0F)
      .add(std::uint32_t{3});
  bytes.add(std::uint32_t{2})
      .add(1.5F)
      .add(2.5F)
      .add(std::uint32_t{0})
      .add(std::uint32_t{1})
      .add(4.5F)
      .add(std::uint32_t{0});
  const auto scan = parse_laser_scan(message("sensor_msgs/MultiEchoLaserScan", bytes.bytes()));
  ASSERT_TRUE(scan);
  EXPECT_THAT(scan->range_m, ElementsAre(1.5F, 0.0F, 4.5F));
}

TEST_P(RosMessages, HoldOdometry) {
  const auto odometry = parse_odometry(
      message("nav_msgs/Odometry", testing::odometry_message(GetParam(), 3.0, 1.25, 0.5)));
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->child_frame, "base_link");
  EXPECT_EQ(odometry->pose.translation_m.x(), 1.25);
  EXPECT_NEAR(odometry->pose.rotation.z(), std::sin(0.25), 1e-15);
}

std::string odometry_with_rotation(Wire wire, const std::vector<double>& rotation) {
  MessageBytes bytes(wire);
  bytes.header(3.0, "odom").text("base_link").numbers({1.25, 0.5, 0.0}).numbers(rotation);
  return bytes.numbers(std::vector<double>(36 + 6 + 36)).bytes();
}

TEST_P(RosMessages, HoldRotationsOfAnyLength) {
  for (const double length : {1e-3, 2.0, 300.0}) {
    const auto odometry = parse_odometry(
        message("nav_msgs/Odometry",
                odometry_with_rotation(GetParam(), {0.0, 0.0, 0.6 * length, 0.8 * length})));
    ASSERT_TRUE(odometry) << length;
    EXPECT_NEAR(odometry->pose.rotation.z(), 0.6, 1e-12) << length;
  }
}

TEST_P(RosMessages, SayWhyTheyAreRefused) {
  const RawMessage zeros =
      message("nav_msgs/Odometry", odometry_with_rotation(GetParam(), {0.0, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(parse_odometry(zeros));
  EXPECT_EQ(why_refused(zeros), "its quaternion is all zeros");
  const RawMessage infinite =
      message("nav_msgs/Odometry", odometry_with_rotation(GetParam(), {0.0, 0.0, NAN, 1.0}));
  EXPECT_FALSE(parse_odometry(infinite));
  EXPECT_EQ(why_refused(infinite), "its quaternion is not finite");
  EXPECT_EQ(why_refused(message("nav_msgs/Odometry", "abc")),
            "it does not decode as nav_msgs/Odometry");
}

TEST_P(RosMessages, HoldTransforms) {
  const auto transforms = parse_transforms(message(
      "tf2_msgs/TFMessage", testing::transform_message(GetParam(), 3.0, "base", "laser",
                                                       {1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0})));
  ASSERT_TRUE(transforms);
  ASSERT_EQ(transforms->size(), 1U);
  EXPECT_EQ(transforms->front().header.frame, "base");
  EXPECT_EQ(transforms->front().parent_from_child.translation_m.y(), 2.0);
}

TEST_P(RosMessages, LeaveOutTransformsThatAreNoRotation) {
  const auto transforms = parse_transforms(message(
      "tf2_msgs/TFMessage", testing::transform_message(GetParam(), 3.0, "base", "laser",
                                                       {1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0})));
  ASSERT_TRUE(transforms);
  EXPECT_TRUE(transforms->empty());
}

TEST_P(RosMessages, HoldTheYawRateOfAnImu) {
  MessageBytes bytes(GetParam());
  std::vector<double> numbers(4 + 9 + 3 + 9 + 3 + 9);
  numbers[4 + 9 + 2] = 0.75;
  const auto imu =
      parse_imu(message("sensor_msgs/Imu", bytes.header(1.0, "imu").numbers(numbers).bytes()));
  ASSERT_TRUE(imu);
  EXPECT_EQ(imu->yaw_rate_radps, 0.75);
}

TEST_P(RosMessages, HoldTheFinitePointsOfACloud) {
  MessageBytes bytes(GetParam());
  bytes.header(1.0, "velodyne").add(std::uint32_t{1}).add(std::uint32_t{2}).add(std::uint32_t{3});
  for (std::uint32_t i = 0; i < 3; ++i)
    bytes.text(std::string(1, static_cast<char>('x' + i)))
        .add(4 * i)
        .add(std::uint8_t{7})
        .add(std::uint32_t{1});
  bytes.add(std::uint8_t{0}).add(std::uint32_t{12}).add(std::uint32_t{24}).add(std::uint32_t{24});
  std::string content = bytes.bytes();
  for (const float value : {1.0F, 2.0F, 3.0F, NAN, 0.0F, 0.0F}) content += testing::raw(value);
  const auto cloud = parse_point_cloud(message("sensor_msgs/PointCloud2", content + '\1'));
  ASSERT_TRUE(cloud);
  ASSERT_EQ(cloud->points_m.size(), 1U);
  EXPECT_EQ(cloud->points_m.front(), Eigen::Vector3f(1.0F, 2.0F, 3.0F));
}

TEST_P(RosMessages, AreRefusedWhereAnyEndIsMissing) {
  const std::string whole = testing::scan_message(GetParam(), {});
  for (std::size_t size = 0; size + 4 < whole.size(); ++size)
    EXPECT_FALSE(parse_laser_scan(message("sensor_msgs/LaserScan", whole.substr(0, size)))) << size;
}

TEST_P(RosMessages, DoNotMakeRoomForWhatIsNotThere) {
  MessageBytes bytes(GetParam());
  bytes.header(1.0, "laser")
      .add(0.0F)
      .add(1.0F)
      .add(0.5F)
      .add(0.0F)
      .add(0.0F)
      .add(0.1F)
      .add(30.0F)
      .add(std::uint32_t{0xFFFFFFFF});
  EXPECT_FALSE(parse_laser_scan(message("sensor_msgs/LaserScan", bytes.bytes())));
}

INSTANTIATE_TEST_SUITE_P(Wires, RosMessages,
                         ::testing::Values(Wire::kRos1, Wire::kCdrLittle, Wire::kCdrBig));

TEST(KindOf, RefusesATypeOfAnotherDefinition) {
  Channel channel{"/scan", "sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369",
                  Serialization::kRos1};
  EXPECT_EQ(kind_of(channel), MessageKind::kLaserScan);
  channel.md5 = "00000000000000000000000000000000";
  EXPECT_EQ(kind_of(channel), MessageKind::kOther);
}

}  // namespace
}  // namespace slammot::bags
