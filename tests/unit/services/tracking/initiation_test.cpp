#include "services/tracking/initiation.hpp"

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using flow::PointLabel;
using testing::Street;
using testing::StreetBox;

const StreetBox kCar{{20.0, 2.0, M_PI / 2.0}};

/// One scan of a car before a wall, compared with earlier scans of the same street with or without
/// it.
class Scene {
 public:
  explicit Scene(bool car_was_there) {
    Street street{{{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}}, {}, {}};
    if (car_was_there) street.unknown = {kCar};
    for (std::int64_t i = 0; i < 20; ++i) {
      const PolarView before(
          detection::detect(street.scan(i * kPeriodNs, static_cast<std::uint32_t>(i)), {}));
      history_.add(i * kPeriodNs, before, std::vector<Owner>(before.beam_count()));
    }
    street.unknown = {kCar};
    scan_ = detection::detect(street.scan(20 * kPeriodNs, 20), {});
    view_.look_at(scan_);
    comparison_.begin(context());
    for (std::size_t s = 0; s < scan_.segments.size(); ++s) comparison_.compare(s, context());
    clear(associations, scan_.segments.size());
  }

  ComparedScan context() const { return {{view_, history_, config}, comparison_}; }
  const flow::Segment& car() const { return scan_.segments[car_segment()]; }
  std::size_t car_segment() const {
    std::size_t s = 0;
    while ((scan_.segments[s].centroid_in_odom_m - Eigen::Vector2d(19.1, 2.0)).norm() > 1.0) ++s;
    return s;
  }
  bool may_initiate_car() const {
    return may_initiate(car_segment(), tracks, associations, context());
  }

  void keep_echoes_of_car(std::size_t count) { scan_.segments[car_segment()].beams.resize(count); }

  TrackingConfig config;
  std::vector<Track> tracks;
  Associations associations;

 private:
  static constexpr std::int64_t kPeriodNs = 100'000'000;
  flow::SegmentedScan scan_;
  ScanView view_;
  ScanHistory history_;
  ScanComparison comparison_;
};

TEST(Initiation, IsOfWhatContradictsTheMapUnlessItStoodThereBefore) {
  EXPECT_TRUE(Scene(false).may_initiate_car());
  EXPECT_FALSE(Scene(true).may_initiate_car()) << "the map is wrong";
}

TEST(Initiation, IsNotOfWhatIsAssigned) {
  Scene scene(false);
  scene.tracks.resize(1);
  scene.associations.shares.resize(1);
  scene.associations.track_of_segment[scene.car_segment()] = 0;
  EXPECT_FALSE(scene.may_initiate_car());
}

TEST(Initiation, IsNotInsideAConfirmedVehicleThatIsSeen) {
  Scene scene(false);
  scene.tracks.resize(1);
  scene.associations.shares.resize(1);
  Track& bus = scene.tracks[0];
  bus.existence.confirmed = true;
  bus.extent.outline = Box();
  bus.extent.footprint().length = {12.0, 0.1};
  bus.extent.footprint().width = {3.0, 0.1};
  bus.kinematics.estimate.mean.head<2>() << 19.5, 2.0;
  EXPECT_TRUE(scene.may_initiate_car()) << "it is hidden, and may be elsewhere";
  scene.associations.shares[0].beams = {1, 2};
  EXPECT_FALSE(scene.may_initiate_car());
}

TEST(Initiation, NeedsTwoEchoes) {
  Scene scene(false);
  scene.keep_echoes_of_car(2);
  EXPECT_TRUE(scene.may_initiate_car());
  scene.keep_echoes_of_car(1);
  EXPECT_FALSE(scene.may_initiate_car());
}

TEST(Initiation, MakesATrackOfTheSegment) {
  Scene scene(false);
  Track track;
  TrackShare share;
  initiate_from_segment(track, share, {{5}, scene.car_segment(), 1, kRoadUsersAnywhere},
                        scene.context());
  EXPECT_EQ(track.track_id.value, 5U);
  EXPECT_EQ(track.history.scanner, 1U);
  EXPECT_EQ(share.beams, scene.car().beams);
  EXPECT_EQ(share.label, PointLabel::kMoving);
  EXPECT_LT((track.position_m() - Eigen::Vector2d(20.0, 2.0)).norm(), 1.5);
  EXPECT_EQ(track.history.observations.size(), 1U);
}

}  // namespace
}  // namespace slammot::tracking
