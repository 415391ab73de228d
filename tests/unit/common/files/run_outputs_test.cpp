#include "common/files/run_outputs.hpp"

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/example_submap.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using geometry::Matrix2;
using geometry::Matrix3;
using geometry::Pose2;
using ::testing::HasSubstr;
using testing::read_file;
using ::testing::StartsWith;

TEST(ToTum, WritesStampPositionAndQuaternion) {
  EXPECT_EQ(
      to_tum({{21'019'900'000, {1.5, -2.0, 0.0}}, {22'000'000'000, {0.0, 0.0, std::acos(-1.0)}}}),
      "21.019900 1.500000 -2.000000 0 0 0 0.000000000 1.000000000\n"
      "22.000000 0.000000 0.000000 0 0 0 1.000000000 0.000000000\n");
}

TEST(ToTracksCsv, WritesOneRowATrackUnderTheAgreedHeader) {
  TrackRow row;
  row.stamp_ns = 1'500'000'000;
  row.track_id = {42};
  row.map_from_object = {1.0, 2.0, 0.5};
  row.velocity_in_map_mps = {3.0, -0.25};
  row.length_m = 4.5;
  row.width_m = 1.8;
  row.motion = flow::Motion::kStopped;
  row.existence = 0.975;
  row.object_class = flow::ObjectClass::kCar;
  EXPECT_EQ(to_tracks_csv({&row}),
            "timestamp,track_id,x,y,heading,vx,vy,length,width,motion,existence,class,occluded\n"
            "1.500000,42,1.000,2.000,0.50000,3.000,-0.250,4.500,1.800,stopped,0.9750,car,0\n");
}

TEST(ToTrackDetailsCsv, WritesCovariancesAndTheProbabilityOfEachMode) {
  TrackRow row;
  row.stamp_ns = 1'500'000'000;
  row.track_id = {42};
  row.covariance_in_map.diagonal() << 0.04, 0.01, 1.0, 0.25;
  row.covariance_in_map(0, 1) = -0.0012345678;
  row.mode_probability = {0.75, 0.25};
  row.class_probability = {0.125, 0.5, 0.25, 0.125};
  EXPECT_EQ(to_track_details_csv({&row}),
            "timestamp,track_id,var_x,cov_xy,var_y,var_vx,cov_vxy,var_vy,p_pedestrian,p_bicycle,p_"
            "car,p_truck_or_bus,mode_0,mode_1\n"
            "1.500000,42,0.04,-0.0012346,0.01,1,0,0.25,0.1250,0.5000,0.2500,0.1250,0.75,0.25\n");
}

TEST(ToPredictionsCsv, WritesOneRowATimeAhead) {
  TrackRow row;
  row.stamp_ns = 1'500'000'000;
  row.track_id = {42};
  row.predicted = {{1.0, {3.0, -1.5}, Matrix2{{0.25, 0.125}, {0.125, 0.5}}},
                   {2.0, {6.0, -3.0}, Matrix2::Identity()}};
  EXPECT_EQ(to_predictions_csv({&row}),
            "timestamp,track_id,after,x,y,var_x,cov_xy,var_y\n"
            "1.500000,42,1.0,3.000,-1.500,0.25,0.125,0.5\n"
            "1.500000,42,2.0,6.000,-3.000,1,0,1\n");
}

TEST(RunRecord, KeepsOfAPathWhatIsWholeSecondsAheadInTheFrameOfTheMap) {
  flow::TrackedObjects tracked;
  tracked.map_from_odom = {10.0, 0.0, 0.5 * std::acos(-1.0)};
  flow::TrackedObject object;
  object.confirmed = true;
  for (const double after_s : {0.5, 1.0, 1.5, 2.0})
    object.predicted_path.push_back({after_s, {after_s, 0.0}, Matrix2{{4.0, 0.0}, {0.0, 1.0}}});
  tracked.objects.push_back(object);
  RunRecord record;
  record.add(tracked);
  ASSERT_EQ(record.track_rows().size(), 1U);
  const std::vector<PredictedPlace> predicted = record.track_rows()[0]->predicted;
  ASSERT_EQ(predicted.size(), 2U);
  EXPECT_THAT(predicted[1].position_in_map_m,
              testing::MatrixNear(geometry::Vector2(10.0, 2.0), 1e-12));
  EXPECT_THAT(predicted[1].covariance_m2,
              testing::MatrixNear(Matrix2{{1.0, 0.0}, {0.0, 4.0}}, 1e-12));
}

TEST(ToOnlineCovarianceCsv, WritesTheUpperTriangle) {
  UncertainStampedPose pose{2'000'000'000, {{1.0, -2.0, 0.5}, Matrix3::Identity() * 1e-6}};
  pose.odom_from_base.covariance(0, 2) = 2.5e-7;
  EXPECT_EQ(to_online_covariance_csv({pose}),
            "timestamp,x,y,heading,var_x,cov_xy,cov_xh,var_y,cov_yh,var_h\n"
            "2.000000,1.000000,-2.000000,0.5000000,1e-06,0,2.5e-07,1e-06,0,1e-06\n");
}

TEST(ToLabelsCsv, WritesALetterABeam) {
  const LabelRow row{1'000'000'000, "-sm?", "-smm"};
  EXPECT_EQ(to_labels_csv({&row}), "timestamp,detection,tracking\n1.000000,-sm?,-smm\n");
}

TEST(ToLabelsCsv, NamesTheScannersWhereThereAreSeveral) {
  const LabelRow front{1'000'000'000, "s", "s", "front"};
  const LabelRow rear{1'000'000'000, "?", "m", "rear"};
  EXPECT_EQ(to_labels_csv({&front}), "timestamp,detection,tracking\n1.000000,s,s\n");
  EXPECT_EQ(to_labels_csv({&front, &rear}),
            "timestamp,detection,tracking,scanner\n1.000000,s,s,front\n1.000000,?,m,rear\n");
}

/// The record of two submaps and a loop between them.
RunRecord small_record() {
  RunRecord record;
  record.add_scan(1'000'000'000);
  record.add(testing::example_submap(0));
  record.add(testing::example_submap(1));
  flow::Constraint loop{
      {0}, {1}, flow::ConstraintKind::kLoop, {{1.0, 2.0, std::acos(0.0)}, Matrix3::Zero()}};
  loop.from_to.covariance.diagonal() << 0.04, 0.01, 0.0025;
  record.add(loop);
  return record;
}

TEST(ToG2o, TurnsCovarianceIntoInformationInTheFrameOfTheEdgesEnd) {
  std::istringstream lines(to_g2o(small_record()));
  std::string line;
  std::vector<double> numbers;
  while (std::getline(lines, line) && !line.starts_with("EDGE_SE2")) {}
  std::istringstream words(line.substr(8));
  for (double number; words >> number;) numbers.push_back(number);
  ASSERT_EQ(numbers.size(), 11u);
  EXPECT_EQ(numbers[0], 0.0);
  EXPECT_EQ(numbers[1], 1.0);
  EXPECT_NEAR(numbers[5], 1.0 / 0.01, 1e-3);  // the end's x is the beginning's y: the edge turns a
                                              // quarter
  EXPECT_NEAR(numbers[8], 1.0 / 0.04, 1e-3);
  EXPECT_NEAR(numbers[10], 1.0 / 0.0025, 1e-3);
}

TEST(ToG2o, HasAVertexForEachSubmapAndHoldsTheFirst) {
  const std::string text = to_g2o(small_record());
  EXPECT_THAT(text, StartsWith("VERTEX_SE2 0 "));
  EXPECT_THAT(text, HasSubstr("\nVERTEX_SE2 1 "));
  EXPECT_THAT(text, HasSubstr("\nFIX 0\n"));
}

TEST(Travelled, DoesNotCountTrembling) {
  std::vector<StampedPose> trajectory;
  for (int i = 0; i <= 1000; ++i)
    trajectory.push_back({i, {i < 500 ? 0.0 : 0.01 * (i - 500), i % 2 ? 0.003 : 0.0, 0.0}});
  EXPECT_NEAR(travelled_m(trajectory), 5.0, 0.1);
}

RunReport example_report(double wall_s) {
  RunReport report;
  report.command = "run";
  report.counters["localization"]["scans"] = 7;
  report.measured.wall_s = wall_s;
  report.measured.stages.push_back(summarize_latency("localization", {3.0, 1.0, 2.0}));
  return report;
}

TEST(WriteOutputs, WritesEveryFileTheSameTwiceButForWhatWasMeasured) {
  const testing::TemporaryFolder folder;
  for (const char* run : {"a", "b"}) {
    std::filesystem::create_directory(folder / run);
    EXPECT_FALSE(write_outputs(folder / run, small_record(), example_report(run[0])));
  }
  for (const char* file :
       {"online.tum", "trajectory.tum", "tracks.csv", "predictions.csv", "lanes.geojson",
        "graph.g2o", "map.pgm", "map.png", "map.yaml", "moving.pgm", "moving.png", "moving.yaml"}) {
    EXPECT_FALSE(read_file(folder / "a" / file).empty()) << file;
    EXPECT_EQ(read_file(folder / "a" / file), read_file(folder / "b" / file)) << file;
  }
  auto report_a = nlohmann::json::parse(read_file(folder / "a" / "report.json"));
  auto report_b = nlohmann::json::parse(read_file(folder / "b" / "report.json"));
  EXPECT_EQ(report_a["counts"]["submaps"], 2);
  EXPECT_EQ(report_a["counts"]["loop_constraints"], 1);
  EXPECT_EQ(report_a["counters"]["localization"]["scans"], 7);
  EXPECT_EQ(report_a["measured"]["stage_latency"]["localization"]["p50_ms"], 2.0);
  EXPECT_NE(report_a, report_b);
  report_a.erase("measured");
  report_b.erase("measured");
  EXPECT_EQ(report_a, report_b);
}

TEST(WriteOutputs, SaysWhichFileCannotBeWritten) {
  const testing::TemporaryFolder folder;
  const auto fault = write_outputs(folder / "missing", small_record(), example_report(1.0));
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->message, HasSubstr("online.tum"));
}

TEST(SummarizeLatency, TellsMedianAndTail) {
  std::vector<double> durations_ms;
  for (int i = 100; i >= 0; --i) durations_ms.push_back(i);
  const StageLatency latency = summarize_latency("x", durations_ms);
  EXPECT_EQ(latency.calls, 101u);
  EXPECT_EQ(latency.p50_ms, 50.0);
  EXPECT_EQ(latency.p99_ms, 99.0);
  EXPECT_EQ(latency.max_ms, 100.0);
  EXPECT_EQ(summarize_latency("none", {}).calls, 0u);
}

}  // namespace
}  // namespace slammot::files
