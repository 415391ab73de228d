#include "services/tracking/labelling.hpp"

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using flow::PointLabel;
using testing::Street;

/// A scan of a moving car before a wall, compared with no earlier one.
struct Scene {
  flow::SegmentedScan scan;
  ScanView view;
  ScanHistory history;
  ScanComparison comparison;
  TrackingConfig config;
  Associations associations;
  std::vector<Track> tracks{1};
  std::size_t car = 0;  ///< Index of its segment.

  Scene() {
    const Street street{{{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}}, {{{20.0, 2.0, M_PI / 2.0}}}, {}};
    scan = detection::detect(street.scan(0, 3), {});
    view.look_at(scan);
    comparison.begin(context());
    for (std::size_t s = 0; s < scan.segments.size(); ++s) comparison.compare(s, context());
    while (scan.segments[car].label != PointLabel::kMoving) ++car;
    associations.shares.resize(1);
    clear(associations, scan.segments.size());
  }

  /// The car belongs to the track.
  void assign_car() {
    associations.track_of_segment[car] = 0;
    associations.shares[0].beams = scan.segments[car].beams;
  }

  ComparedScan context() const { return {{view, history, config}, comparison}; }
  const std::vector<std::uint16_t>& car_beams() const { return scan.segments[car].beams; }
};

TEST(Labelling, HoldsTheBeamsOfConfirmedTracksToBeMoving) {
  Scene scene;
  scene.assign_car();
  scene.tracks[0].existence.confirmed = true;
  std::vector<PointLabel> labels(scene.scan.labels.size(), PointLabel::kUnknown);
  label_beams(scene.tracks, scene.associations, scene.context(), labels);
  for (const std::uint16_t beam : scene.car_beams()) EXPECT_EQ(labels[beam], PointLabel::kMoving);
}

TEST(Labelling, CorrectsALoneContradictionInAStationarySegment) {
  Scene scene;
  std::size_t wall = 0;
  while (scene.scan.segments[wall].label != PointLabel::kStationary) ++wall;
  std::vector<PointLabel> labels = scene.scan.labels;
  const std::uint16_t beam = scene.scan.segments[wall].beams[1];
  labels[beam] = PointLabel::kMoving;
  label_beams(scene.tracks, scene.associations, scene.context(), labels);
  EXPECT_EQ(labels[beam], PointLabel::kStationary);
}

TEST(Labelling, NamesTheOwnerOfEachBeam) {
  Scene scene;
  scene.assign_car();
  scene.tracks[0].track_id = {9};
  scene.tracks[0].existence.confirmed = true;
  scene.tracks[0].extent.outline = Box();
  std::vector<Owner> owners;
  find_owners(scene.tracks, scene.associations, scene.context(), owners);
  ASSERT_EQ(owners.size(), scene.scan.range_m.size());
  const Owner& of_car = owners[scene.car_beams()[0]];
  EXPECT_TRUE(of_car.is_owned && of_car.is_confirmed && of_car.has_come);
  EXPECT_EQ(of_car.track_id.value, 9U);
  std::size_t owned = 0;
  for (const Owner& owner : owners) owned += owner.is_owned ? 1 : 0;
  EXPECT_EQ(owned, scene.car_beams().size());
}

TEST(Labelling, KeepsThePointsOfATentativeTrackOfTheLast64Scans) {
  Scene scene;
  Track& track = scene.tracks[0];
  for (int i = 0; i < 70; ++i) {
    scene.scan.sequence = static_cast<std::uint32_t>(i);
    keep_points(track, scene.car_beams(), 0, scene.context());
  }
  ASSERT_EQ(track.history.past_points.size(), 64U);
  EXPECT_EQ(track.history.past_points.front().points.sequence, 6U);
  EXPECT_EQ(track.history.past_points.back().points.beams, scene.car_beams());
  Track confirmed;
  confirmed.existence.confirmed = true;
  keep_points(confirmed, scene.car_beams(), 0, scene.context());
  EXPECT_TRUE(confirmed.history.past_points.empty());
}

}  // namespace
}  // namespace slammot::tracking
