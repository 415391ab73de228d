#include "services/evaluator/drive_data.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/evaluator/doubts.hpp"

namespace slammot::evaluator {
namespace {

using geometry::Pose2;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kScanNs = 50'000'000;

/// A drive along x at 10 m/s, 20 scans a second, with one car; online poses are 1 m to the left.
RunResult drive(int scans) {
  RunResult result;
  for (int i = 0; i < scans; ++i) {
    const std::int64_t stamp_ns = i * kScanNs;
    result.corrected.push_back({stamp_ns, {0.5 * i, 0.0, 0.0}});
    result.online.push_back({stamp_ns, {0.5 * i, 1.0, 0.0}});
    result.uncertain.push_back(
        {stamp_ns, {{0.5 * i, 1.0, 0.0}, 1e-4 * geometry::Matrix3::Identity()}});
    ResultTrack car;
    car.track_id = 7;
    car.map_from_object = {0.5 * i + 10.0, 4.0, 0.5};
    car.velocity_in_map_mps = {10.0, 0.0};
    car.length_m = 4.5;
    car.width_m = 1.8;
    car.object_class = "car";
    result.tracks.push_back({stamp_ns, {car}});
  }
  return result;
}

/// A column of the data, as numbers.
template <typename Number>
std::vector<Number> column(const DriveData& data, const std::string& name) {
  const auto header = nlohmann::json::parse(data.header);
  for (const auto& entry : header["columns"]) {
    if (entry[0] != name) continue;
    std::vector<Number> values(entry[3].get<std::size_t>());
    std::memcpy(values.data(), data.bytes.data() + entry[2].get<std::size_t>(),
                values.size() * sizeof(Number));
    return values;
  }
  return {};
}

TEST(DriveData, HoldsTenFramesASecond) {
  const DriveData data = encode_drive(drive(41), nullptr);
  const auto times = column<float>(data, "time");
  ASSERT_EQ(times.size(), 21U);
  EXPECT_FLOAT_EQ(times[1], 0.1F);
  EXPECT_EQ(column<std::uint32_t>(data, "first_row").size(), 22U);
}

TEST(DriveData, HoldsLanesInDecimetres) {
  RunResult result = drive(3);
  EXPECT_TRUE(nlohmann::json::parse(encode_drive(result, nullptr).header)["lanes"].empty());
  traffic::Way lane;
  lane.mover = traffic::Mover::kVehicle;
  lane.points_in_map_m = {{0.04, -2.0}, {10.06, -2.0}};
  lane.width_m = 2.83;
  lane.confidence = 0.667;
  traffic::Way walkway = lane;
  walkway.mover = traffic::Mover::kPedestrian;
  result.ways = {lane, walkway};
  const auto lanes = nlohmann::json::parse(encode_drive(result, nullptr).header)["lanes"];
  ASSERT_EQ(lanes.size(), 2U);
  EXPECT_EQ(lanes[0]["points"], nlohmann::json::parse("[0.0, -2.0, 10.1, -2.0]"));
  EXPECT_EQ(lanes[0]["width"], 2.8);
  EXPECT_EQ(lanes[0]["confidence"], 0.67);
  EXPECT_EQ(lanes[0]["color"], "car");
  EXPECT_TRUE(lanes[0]["directed"]);
  EXPECT_EQ(lanes[1]["color"], "pedestrian");
  EXPECT_FALSE(lanes[1]["directed"]);
}

TEST(DriveData, MovesTracksWithTheCorrectedPose) {
  const DriveData data = encode_drive(drive(3), nullptr);
  EXPECT_FLOAT_EQ(column<float>(data, "track_y")[0], 3.0F);
  EXPECT_FLOAT_EQ(column<float>(data, "track_x")[0], 10.0F);
  EXPECT_EQ(column<std::int16_t>(data, "vx")[0], 1000);
  EXPECT_EQ(column<std::uint8_t>(data, "length")[0], 45);
  EXPECT_EQ(column<std::int16_t>(data, "track_heading")[0], 5000);
  EXPECT_EQ(column<std::uint8_t>(data, "flags")[0], 3 + 8);
}

TEST(DriveData, LimitsWhatDoesNotFitItsColumns) {
  RunResult result = drive(1);
  ResultTrack& track = result.tracks[0].tracks[0];
  track.length_m = 1e9;
  track.velocity_in_map_mps = {-1e9, std::numeric_limits<double>::quiet_NaN()};
  track.map_from_object.heading_rad = 3.0 * std::numbers::pi;
  const DriveData data = encode_drive(result, nullptr);
  EXPECT_EQ(column<std::uint8_t>(data, "length")[0], 255);
  EXPECT_EQ(std::abs(column<std::int16_t>(data, "track_heading")[0]), 31416);
}

TEST(DriveData, StaysSmallForAnHourOfTraffic) {
  RunResult result = drive(36'000);
  for (TracksAt& at : result.tracks) at.tracks.resize(20, at.tracks.front());
  const DriveData data = encode_drive(result, nullptr);
  EXPECT_LT(data.bytes.size(), 6'000'000U);
  EXPECT_GT(data.bytes.size(), 3'000'000U);
}

TEST(DriveData, HoldsNoTagOfAPage) {
  RunResult result = drive(2);
  result.graph.map_from_submap = {{1, Pose2::identity()}, {2, Pose2::identity()}};
  result.graph.edges = {{1, 2, true, "</script>", "<b>"}};
  EXPECT_THAT(encode_drive(result, nullptr).header, Not(HasSubstr("<")));
}

TEST(Doubts, NameTheTimeOfAGreatStandardDeviation) {
  RunResult result = drive(100);
  for (int i = 40; i < 60; ++i) result.uncertain[i].odom_from_base.covariance *= 900.0;  // 0.3 m
  const auto doubts = find_doubts(result);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].begin_ns, 40 * kScanNs);
  EXPECT_EQ(doubts[0].end_ns, 59 * kScanNs);
  EXPECT_THAT(doubts[0].what, HasSubstr("0.30 m"));
}

TEST(Doubts, NameGapsAndLosses) {
  RunResult result = drive(100);
  result.uncertain.erase(result.uncertain.begin() + 20, result.uncertain.begin() + 60);
  result.losses.push_back({70 * kScanNs, 80 * kScanNs});
  std::vector<std::string> words;
  for (const Doubt& doubt : find_doubts(result)) words.push_back(doubt.what);
  EXPECT_THAT(words, ElementsAre("no scan was localized", "lost: scans do not match the map"));
}

TEST(Doubts, AreTheTimeBeforeADriveWasLocatedInAStoredMap) {
  RunResult result = drive(100);
  result.report_json = R"({"located_at_s": 1.5})";
  const auto before = time_before_located(result);
  ASSERT_TRUE(before);
  EXPECT_EQ(before->end_ns - before->begin_ns, 1'500'000'000);
  EXPECT_EQ(find_doubts(result).size(), 1U);
  result.report_json = R"({"located_at_s": null})";
  EXPECT_EQ(time_before_located(result)->end_ns, result.online.back().stamp_ns);
}

TEST(Doubts, AreNoneInASoundDrive) { EXPECT_TRUE(find_doubts(drive(100)).empty()); }

}  // namespace
}  // namespace slammot::evaluator
