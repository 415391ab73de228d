#include "services/tracking/association.hpp"

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using testing::Street;
using testing::StreetBox;

constexpr std::int64_t kPeriodNs = 100'000'000;

/// One scan of movers before a wall, after a second in which all was as now or only the wall was
/// there.
class Scene {
 public:
  Scene(const std::vector<StreetBox>& movers, bool they_were_there, TrackingConfig config = {})
      : config_(config), associator_(config) {
    Street street{{{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}}, {}, {}};
    if (they_were_there) street.unknown = movers;
    for (std::int64_t i = 0; i < 10; ++i) {
      const PolarView view(
          detection::detect(street.scan(i * kPeriodNs, static_cast<std::uint32_t>(i)), {}));
      history_.add(i * kPeriodNs, view, std::vector<Owner>(view.beam_count()));
    }
    street.unknown = movers;
    scan_ = detection::detect(street.scan(10 * kPeriodNs, 10), {});
    view_.look_at(scan_);
    comparison_.begin(context());
    for (std::size_t s = 0; s < scan_.segments.size(); ++s) comparison_.compare(s, context());
  }

  /// A confirmed pedestrian at this place.
  void add_pedestrian(const Eigen::Vector2d& position_m, double speed_mps = 1.2) {
    Track& track = tracks.emplace_back();
    track.track_id = {static_cast<std::uint32_t>(tracks.size())};
    track.existence.confirmed = true;
    track.extent.footprint().length = track.extent.footprint().width = {0.4, 0.1};
    track.extent.largest_span_m = 0.4;
    filters::MotionState state;
    state.mean << position_m, 0.0, speed_mps, 0.0, 0.0;
    state.covariance = 0.02 * filters::Matrix6::Identity();
    restart_from(track.kinematics, state, config_);
  }

  void associate() {
    associations.shares.resize(tracks.size());
    associator_.associate(tracks, context(), associations);
  }

  ComparedScan context() const { return {{view_, history_, config_}, comparison_}; }

  /// Mean coordinate across the view of the echoes of a track.
  double mean_y_m(std::size_t track) const {
    double sum_m = 0.0;
    for (const std::uint16_t beam : associations.shares[track].beams)
      sum_m += view_.point_in_odom_m(beam).y();
    return sum_m / static_cast<double>(associations.shares[track].beams.size());
  }

  std::vector<Track> tracks;
  Associations associations;

 private:
  TrackingConfig config_;
  Associator associator_;
  flow::SegmentedScan scan_;
  ScanView view_;
  ScanHistory history_;
  ScanComparison comparison_;
};

StreetBox pedestrian_at(double y_m) { return {{8.0, y_m, 0.0}, 0.4, 0.4}; }

TEST(Association, IsTheBestForAllTracksTogether) {
  for (const int most_hypotheses : {1, 4}) {
    TrackingConfig config;
    config.association.most_hypotheses = most_hypotheses;
    Scene scene({pedestrian_at(0.0), pedestrian_at(0.9)}, false, config);
    scene.add_pedestrian({7.9, 0.4});  // nearer to the first segment than to the second, but that
                                       // is the other's
    scene.add_pedestrian({7.9, -0.05});
    scene.associate();
    ASSERT_TRUE(scene.associations.has_echoes(0)) << most_hypotheses;
    ASSERT_TRUE(scene.associations.has_echoes(1)) << most_hypotheses;
    EXPECT_NEAR(scene.mean_y_m(0), 0.9, 0.15) << most_hypotheses;
    EXPECT_NEAR(scene.mean_y_m(1), 0.0, 0.15) << most_hypotheses;
  }
}

TEST(Association, LeavesATrackWithoutEchoesWhereNoSegmentIsInItsGate) {
  Scene scene({pedestrian_at(0.0)}, false);
  scene.add_pedestrian({8.0, 6.0});
  scene.associate();
  EXPECT_FALSE(scene.associations.has_echoes(0));
}

TEST(Association, DoesNotGiveAPedestrianWhatHasStoodThereForLong) {
  Scene scene({pedestrian_at(0.0)}, true);
  scene.add_pedestrian({8.0, 0.1});
  scene.associate();
  EXPECT_FALSE(scene.associations.has_echoes(0)) << "a post that they pass";
}

}  // namespace
}  // namespace slammot::tracking
