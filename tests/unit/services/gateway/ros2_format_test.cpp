#include "services/gateway/ros2_format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bags/ros_messages.hpp"
#include "foxglove.pb.h"
#include "services/gateway/cdr_writer.hpp"
#include "services/gateway/ros2_definitions.hpp"

namespace slammot::gateway {
namespace {

using ::testing::StartsWith;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

bags::RawMessage message_of(const bags::Channel& channel, const std::string& cdr) {
  return {&channel, 0, {reinterpret_cast<const std::uint8_t*>(cdr.data()), cdr.size()}};
}

TEST(CdrWriter, AlignsNumbersToTheirSizeAfterTheHeader) {
  CdrWriter writer;
  writer.put(std::uint8_t{7});
  writer.put(std::uint32_t{1});
  writer.put(std::string_view("ab"));
  writer.put(1.0);
  const std::string expected(
      "\0\1\0\0"
      "\7\0\0\0"
      "\1\0\0\0"
      "\3\0\0\0ab\0\0"
      "\0\0\0\0\0\0\xf0\x3f",
      28);
  EXPECT_EQ(std::move(writer).take(), expected);
}

TEST(Ros2Definition, HoldsEachPartOnce) {
  const std::string text = ros2_definition("nav_msgs/msg/Path");
  EXPECT_THAT(text, StartsWith("std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n====="));
  for (const char* part :
       {"std_msgs/Header", "geometry_msgs/PoseStamped", "geometry_msgs/Pose", "geometry_msgs/Point",
        "geometry_msgs/Quaternion", "builtin_interfaces/Time"})
    EXPECT_EQ(count_of(text, "MSG: " + std::string(part) + "\n"), 1U) << part;
}

TEST(Ros2Format, WritesAScanWithTheFiguresOfItsScanner) {
  foxglove::LaserScan scan;
  scan.mutable_timestamp()->set_seconds(12);
  scan.mutable_timestamp()->set_nanos(345);
  scan.set_frame_id("laser_front");
  scan.set_start_angle(-1.0);
  scan.set_end_angle(1.0);
  for (const double range_m : {1.0, 2.0, 3.0}) scan.add_ranges(range_m);
  const auto format = ros2_format();
  format->know({"front", {}, -1.0, 1.0, 81.0, 0.1});
  const auto cdr = format->encoded(ChannelId::kScan, scan.SerializeAsString());
  ASSERT_TRUE(cdr);
  const bags::Channel channel{"/scan", "sensor_msgs/LaserScan", "", bags::Serialization::kCdr};
  const auto read = bags::parse_laser_scan(message_of(channel, *cdr));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->header.stamp_ns, 12'000'000'345);
  EXPECT_EQ(read->header.frame, "laser_front");
  EXPECT_FLOAT_EQ(read->first_beam_rad, -1.0F);
  EXPECT_FLOAT_EQ(read->beam_step_rad, 1.0F);
  EXPECT_FLOAT_EQ(read->most_range_m, 81.0F);
  EXPECT_THAT(read->range_m, ::testing::ElementsAre(1.0F, 2.0F, 3.0F));
}

TEST(Ros2Format, GivesPointsAThirdCoordinate) {
  foxglove::PointCloud cloud;
  cloud.set_frame_id("base");
  cloud.set_point_stride(8);
  for (const auto& [name, offset] : {std::pair("x", 0U), std::pair("y", 4U)}) {
    foxglove::PackedElementField& field = *cloud.add_fields();
    field.set_name(name);
    field.set_offset(offset);
    field.set_type(foxglove::PackedElementField::FLOAT32);
  }
  const float points[] = {1.0F, 2.0F, 3.0F, 4.0F};
  cloud.set_data(points, sizeof points);
  const auto cdr = ros2_format()->encoded(ChannelId::kPoints, cloud.SerializeAsString());
  ASSERT_TRUE(cdr);
  const bags::Channel channel{"/p", "sensor_msgs/PointCloud2", "", bags::Serialization::kCdr};
  const auto read = bags::parse_point_cloud(message_of(channel, *cdr));
  ASSERT_TRUE(read);
  EXPECT_THAT(read->points_m, ::testing::ElementsAre(Eigen::Vector3f(1.0F, 2.0F, 0.0F),
                                                     Eigen::Vector3f(3.0F, 4.0F, 0.0F)));
}

TEST(Ros2Format, RefusesWhatIsNoMessage) {
  EXPECT_FALSE(ros2_format()->encoded(ChannelId::kScan, "\xff\xff"));
  EXPECT_FALSE(ros2_format()->encoded(ChannelId::kGraph, "{}"));
  for (const char* text :
       {"", "{}", R"({"stamp_ns":"now"})", R"({"stamp_ns":"1","odom_from_base":[1]})"})
    EXPECT_FALSE(ros2_format()->encoded(ChannelId::kPoseDetails, text)) << text;
}

}  // namespace
}  // namespace slammot::gateway
