#include "examples/greedy_tracker/greedy_tracker.hpp"

#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::greedy_tracker {
namespace {

using flow::PointLabel;
using geometry::Vector2;
using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kPeriodS = 1.0 / 37.5;

flow::Segment moving_segment(const Vector2& centre_m) {
  flow::Segment segment;
  segment.label = PointLabel::kMoving;
  segment.centroid_in_odom_m = segment.box_centre_in_odom_m = centre_m;
  segment.centroid_covariance_m2 = 1e-4 * Eigen::Matrix2d::Identity();
  segment.box_length_m = 0.5;
  segment.box_width_m = 0.4;
  return segment;
}

/// A scan with these segments of three beams each.
flow::SegmentedScan scan_of(double time_s, std::vector<flow::Segment> segments) {
  flow::SegmentedScan scan;
  scan.stamp_ns = std::llround(time_s * 1e9);
  scan.sequence = static_cast<std::uint32_t>(std::lround(time_s / kPeriodS));
  scan.scanner_id = "front";
  for (flow::Segment& segment : segments) {
    for (int beam = 0; beam < 3; ++beam) {
      segment.beams.push_back(static_cast<std::uint16_t>(scan.labels.size()));
      scan.labels.push_back(segment.label);
    }
  }
  scan.range_m.assign(scan.labels.size(), 10.0F);
  scan.points_in_base_m.assign(scan.labels.size(), Eigen::Vector2f::Zero());
  scan.segments = std::move(segments);
  return scan;
}

std::vector<flow::TrackedObject> confirmed(const stages::TrackingResult& result) {
  std::vector<flow::TrackedObject> objects;
  for (const flow::TrackedObject& object : result.objects.objects)
    if (object.confirmed) objects.push_back(object);
  return objects;
}

/// Objects that move at constant velocity in view of the tracker.
struct Scene {
  struct Mover {
    Vector2 start_m;
    Vector2 velocity_mps;
    Vector2 at(double time_s) const { return start_m + time_s * velocity_mps; }
  };
  std::vector<Mover> movers;
  GreedyTracker tracker{GreedyTrackerConfig{}};
  stages::TrackingResult result;

  void run(double from_s, double to_s) {
    for (double time_s = from_s; time_s < to_s; time_s += kPeriodS) {
      std::vector<flow::Segment> segments;
      for (const Mover& mover : movers) segments.push_back(moving_segment(mover.at(time_s)));
      result = tracker.step(scan_of(time_s, std::move(segments)));
    }
  }
};

TEST(GreedyTracker, EstimatesPositionAndVelocityAtConstantVelocity) {
  Scene scene{.movers = {{{10.0, -5.0}, {1.0, 6.0}}}};
  scene.run(0.0, 2.0);
  ASSERT_THAT(confirmed(scene.result), SizeIs(1));
  const flow::TrackedObject object = confirmed(scene.result).front();
  const double time_s = static_cast<double>(scene.result.objects.stamp_ns) * 1e-9;
  EXPECT_LT((object.position_in_odom_m - scene.movers.front().at(time_s)).norm(), 0.02);
  EXPECT_LT((object.velocity_in_odom_mps - Vector2(1.0, 6.0)).norm(), 0.1);
  EXPECT_EQ(object.motion, flow::Motion::kMoving);
}

TEST(GreedyTracker, PredictsAlongTheVelocityWithGrowingUncertainty) {
  Scene scene{.movers = {{{10.0, -5.0}, {0.0, 6.0}}}};
  scene.run(0.0, 2.0);
  const flow::TrackedObject object = confirmed(scene.result).at(0);
  ASSERT_THAT(object.predicted_path, ::testing::Not(IsEmpty()));
  double trace_before_m2 = object.covariance.topLeftCorner<2, 2>().trace();
  for (const flow::PredictedPosition& there : object.predicted_path) {
    EXPECT_LT((there.position_in_odom_m -
               (object.position_in_odom_m + there.after_s * object.velocity_in_odom_mps))
                  .norm(),
              1e-9);
    EXPECT_GT(there.covariance_m2.trace(), trace_before_m2);
    trace_before_m2 = there.covariance_m2.trace();
  }
}

TEST(GreedyTracker, IsEquivariantUnderAMotionOfTheWorld) {
  const Vector2 shift_m(100.0, -40.0);
  Scene here{.movers = {{{10.0, -5.0}, {1.0, 6.0}}}};
  Scene there{.movers = {{Vector2(10.0, -5.0) + shift_m, {1.0, 6.0}}}};
  here.run(0.0, 1.0);
  there.run(0.0, 1.0);
  const flow::TrackedObject a = confirmed(here.result).at(0), b = confirmed(there.result).at(0);
  EXPECT_LT((b.position_in_odom_m - a.position_in_odom_m - shift_m).norm(), 1e-9);
  EXPECT_LT((b.velocity_in_odom_mps - a.velocity_in_odom_mps).norm(), 1e-9);
}

TEST(GreedyTracker, KeepsTheIdsOfTwoObjectsThatPassEachOther) {
  Scene scene{.movers = {{{-8.0, 0.0}, {5.0, 0.0}}, {{8.0, 2.0}, {-5.0, 0.0}}}};
  scene.run(0.0, 1.0);
  ASSERT_THAT(confirmed(scene.result), SizeIs(2));
  const auto to_the_right = [](const stages::TrackingResult& result) {
    for (const flow::TrackedObject& object : confirmed(result))
      if (object.velocity_in_odom_mps.x() > 0.0) return object.track_id;
    return flow::TrackId{};
  };
  const flow::TrackId before = to_the_right(scene.result);
  scene.run(1.0, 3.0);
  EXPECT_THAT(confirmed(scene.result), SizeIs(2));
  EXPECT_EQ(to_the_right(scene.result), before);
}

TEST(GreedyTracker, AssignsASegmentToTheNearestTrack) {
  Scene scene{.movers = {{{10.0, 0.0}, {0.0, 3.0}}, {{11.0, 0.0}, {0.0, 3.0}}}};
  scene.run(0.0, 1.0);
  ASSERT_THAT(scene.result.objects.objects, SizeIs(2));
  const std::int64_t last_ns = scene.result.objects.stamp_ns;
  const double next_s = static_cast<double>(last_ns) * 1e-9 + kPeriodS;
  // nearer to the second one
  scene.result = scene.tracker.step(scan_of(next_s, {moving_segment({10.6, 3.0 * next_s})}));
  ASSERT_THAT(scene.result.objects.objects, SizeIs(2));
  EXPECT_EQ(scene.result.objects.objects.at(0).last_seen_ns, last_ns);
  EXPECT_EQ(scene.result.objects.objects.at(1).last_seen_ns, scene.result.objects.stamp_ns);
}

TEST(GreedyTracker, DoesNotConfirmAStationaryObject) {
  Scene scene{.movers = {{{10.0, 0.0}, {0.0, 0.0}}}};
  scene.run(0.0, 3.0);
  EXPECT_THAT(confirmed(scene.result), IsEmpty());
  EXPECT_THAT(scene.result.labels.labels, Each(PointLabel::kStationary))
      << "the map is told that it stands";
}

TEST(GreedyTracker, LabelsSegmentsOfConfirmedTracksMoving) {
  Scene scene{.movers = {{{10.0, 0.0}, {0.0, 5.0}}}};
  scene.run(0.0, 2.0);
  EXPECT_THAT(scene.result.labels.labels, Each(PointLabel::kMoving));
}

TEST(GreedyTracker, DeletesAnUnseenTrackAndNeverReusesItsId) {
  Scene scene{.movers = {{{10.0, 0.0}, {0.0, 5.0}}}};
  scene.run(0.0, 2.0);
  const flow::TrackId gone = confirmed(scene.result).at(0).track_id;
  scene.movers.clear();
  scene.run(2.0, 2.5);
  EXPECT_THAT(confirmed(scene.result), SizeIs(1)) << "predicted for a while";
  scene.run(2.5, 3.0);
  EXPECT_THAT(scene.result.objects.objects, IsEmpty());
  scene.movers = {{{10.0, -15.0}, {0.0, 5.0}}};
  scene.run(3.0, 5.0);
  ASSERT_THAT(confirmed(scene.result), SizeIs(1));
  EXPECT_GT(confirmed(scene.result).at(0).track_id, gone);
}

TEST(GreedyTracker, AnswersALateScanWithoutChangingItsTracks) {
  Scene scene{.movers = {{{10.0, 0.0}, {0.0, 5.0}}}};
  scene.run(0.0, 1.0);
  const auto now = confirmed(scene.result).at(0);
  const stages::TrackingResult late =
      scene.tracker.step(scan_of(0.5, {moving_segment({10.0, 2.5})}));
  EXPECT_THAT(late.labels.labels, SizeIs(3));
  EXPECT_EQ(confirmed(late).at(0).last_seen_ns, now.last_seen_ns);
  EXPECT_EQ(scene.tracker.named_counters().at("late_scans"), 1U);
}

/// Starts from the scanner's beams: a car of 4.5 m that crosses 20 m ahead.
TEST(GreedyTracker, TracksACarThatDetectionSegments) {
  testing::Street street;
  street.known = {{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}};
  GreedyTracker tracker{GreedyTrackerConfig{}};
  std::set<flow::TrackId> ids;
  stages::TrackingResult result;
  double time_s = 0.0;
  for (std::uint32_t scan = 0; scan < 75; ++scan) {
    time_s = scan * kPeriodS;
    street.unknown = {{{20.0, -15.0 + 8.0 * time_s, M_PI / 2.0}}};
    result = tracker.step(detection::detect(street.scan(std::llround(time_s * 1e9), scan), {}));
    for (const flow::TrackedObject& object : confirmed(result)) ids.insert(object.track_id);
  }
  EXPECT_THAT(ids, SizeIs(1));
  ASSERT_THAT(confirmed(result), SizeIs(1));
  EXPECT_LT(
      (confirmed(result).front().position_in_odom_m - Vector2(20.0, -15.0 + 8.0 * time_s)).norm(),
      1.0);
  EXPECT_LT((confirmed(result).front().velocity_in_odom_mps - Vector2(0.0, 8.0)).norm(), 1.0);
}

}  // namespace
}  // namespace slammot::greedy_tracker
