#include "services/tracking/segment_parts.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using testing::Street;

/// One scan of these moving objects before a wall, and tracks without segments.
class Scene {
 public:
  explicit Scene(const std::vector<testing::StreetBox>& movers) {
    const Street street{{{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}}, movers, {}};
    scan_ = detection::detect(street.scan(0, 0), {});
    view_.look_at(scan_);
    comparison_.begin(context());
    for (std::size_t s = 0; s < scan_.segments.size(); ++s) comparison_.compare(s, context());
  }

  ComparedScan context() const { return {{view_, history_, config_}, comparison_}; }

  Track& add_track() {
    tracks.emplace_back();
    associations.shares.resize(tracks.size());
    clear(associations, scan_.segments.size());
    return tracks.back();
  }

  std::size_t segments_of(std::size_t track) const {
    return static_cast<std::size_t>(std::ranges::count(associations.track_of_segment, track));
  }

  std::vector<Track> tracks;
  Associations associations;

 private:
  flow::SegmentedScan scan_;
  ScanView view_;
  ScanHistory history_;
  ScanComparison comparison_;
  TrackingConfig config_;
};

void place_box(Track& track, const Eigen::Vector2d& centre_m, double length_m, double width_m) {
  track.existence.confirmed = true;
  track.extent.outline = Box();
  track.extent.footprint().length = {length_m, 0.1};
  track.extent.footprint().width = {width_m, 0.1};
  track.kinematics.estimate.mean.head<2>() = centre_m;
  track.kinematics.estimate.covariance = 0.01 * filters::Matrix6::Identity();
}

TEST(SegmentParts, JoinTheBoxThatTheyLieIn) {
  Scene scene(
      {{{15.0, -1.5, 0.0}, 0.5, 0.5}, {{15.0, 1.5, 0.0}, 0.5, 0.5}, {{15.0, 8.0, 0.0}, 0.5, 0.5}});
  place_box(scene.add_track(), {15.0, 0.0}, 3.0, 5.0);
  assign_parts(scene.tracks, scene.context(), scene.associations);
  EXPECT_EQ(scene.segments_of(0), 2U) << "the two inside, not the third";
}

TEST(SegmentParts, AreLegsOfAPedestrianWithinAStride) {
  Scene scene({{{8.0, 0.0, 0.0}, 0.15, 0.15},
               {{8.0, 0.4, 0.0}, 0.15, 0.15},
               {{8.0, 2.0, 0.0}, 0.15, 0.15}});
  Track& pedestrian = scene.add_track();
  pedestrian.kinematics.estimate.mean.head<2>() << 7.95, 0.2;
  pedestrian.extent.largest_span_m = 0.5;
  assign_parts(scene.tracks, scene.context(), scene.associations);
  EXPECT_EQ(scene.segments_of(0), 2U);
}

TEST(SharedSegments, GiveEachTrackTheEchoesInItsPlace) {
  Scene scene({{{15.0, 0.0, 0.0}, 1.0, 4.0}});  // two tracks, one segment
  place_box(scene.add_track(), {15.0, -1.0}, 1.0, 2.0);
  place_box(scene.add_track(), {15.0, 1.0}, 1.0, 2.0);
  const std::vector<flow::Segment>& segments = scene.context().scan().segments;
  const auto shared = static_cast<std::size_t>(
      std::ranges::find(segments, flow::PointLabel::kMoving, &flow::Segment::label) -
      segments.begin());
  scene.associations.track_of_segment[shared] = 0;
  scene.associations.shares[0].beams = segments[shared].beams;
  divide_shared_segments(scene.tracks, scene.context(), scene.associations);
  ASSERT_TRUE(scene.associations.has_echoes(0));
  ASSERT_TRUE(scene.associations.has_echoes(1));
  EXPECT_EQ(scene.associations.shares[0].beams.size() + scene.associations.shares[1].beams.size(),
            segments[shared].beams.size());
  for (const std::uint16_t beam : scene.associations.shares[1].beams)
    EXPECT_GT(scene.context().view.point_in_odom_m(beam).y(), 0.0);
  EXPECT_EQ(scene.associations.shares[1].label, flow::PointLabel::kMoving);
}

TEST(SharedSegments, AreNotDividedForATentativeTrack) {
  Scene scene({{{15.0, 0.0, 0.0}, 1.0, 4.0}});
  place_box(scene.add_track(), {15.0, 0.0}, 1.0, 4.0);
  scene.tracks[0].existence.confirmed = false;
  divide_shared_segments(scene.tracks, scene.context(), scene.associations);
  EXPECT_FALSE(scene.associations.has_echoes(0));
}

}  // namespace
}  // namespace slammot::tracking
