#include "services/tracking/velocity_check.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using testing::Street;

constexpr std::int64_t kPeriodNs = 100'000'000;
constexpr std::int64_t kStartNs = 10'000'000'000;
constexpr double kSpeedMps = 8.0;

/// A car that crosses at 8 m/s before a wall, ten scans a second for a second, and a track of it
/// with this speed.
class Scene {
 public:
  explicit Scene(double tracked_mps) {
    Street street{{{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}}, {}, {}};
    for (std::int64_t i = 0; i <= 10; ++i) {
      const double y_m = -4.0 + kSpeedMps * static_cast<double>(i * kPeriodNs) * 1e-9;
      street.unknown = {{{20.0, y_m, M_PI / 2.0}}};
      scan_ = detection::detect(
          street.scan(kStartNs + i * kPeriodNs, static_cast<std::uint32_t>(i)), {});
      if (i == 10) break;
      const PolarView before(scan_);
      history_.add(kStartNs + i * kPeriodNs, before, std::vector<Owner>(before.beam_count()));
    }
    view_.look_at(scan_);
    for (const flow::Segment& segment : scan_.segments)
      if (segment.label == flow::PointLabel::kMoving)
        for (const std::uint16_t beam : segment.beams)
          points_m_.push_back(view_.point_in_odom_m(beam));
    track.track_id = {1};
    track.history.first_seen_ns = kStartNs;
    track.extent.outline = Box();
    track.extent.footprint().heading_rad = M_PI / 2.0;
    filters::MotionState state;
    state.mean << 20.0, 4.0, 0.0, tracked_mps, 0.0, 0.0;
    state.covariance = 0.05 * filters::Matrix6::Identity();
    restart_from(track.kinematics, state, config_);
  }

  void check() {
    Observation observation;
    observation.points_m = points_m_;
    check_velocity(track, observation, {view_, history_, config_});
  }

  Track track;

 private:
  flow::SegmentedScan scan_;
  ScanView view_;
  ScanHistory history_;
  TrackingConfig config_;
  std::vector<Eigen::Vector2d> points_m_;
};

TEST(VelocityCheck, LeavesAVelocityThatEarlierScansConfirm) {
  Scene scene(kSpeedMps);
  scene.check();
  EXPECT_FALSE(scene.track.existence.velocity_check.is_refuted);
  EXPECT_NEAR(scene.track.velocity_mps().y(), kSpeedMps, 1e-9);
}

TEST(VelocityCheck, ReplacesOneThatTheyContradictIfTheyTellTheSpeed) {
  Scene scene(-12.0);
  scene.check();
  EXPECT_NEAR(scene.track.velocity_mps().y(), kSpeedMps, 2.5);
  EXPECT_EQ(scene.track.position_m(), Eigen::Vector2d(20.0, 4.0));
}

TEST(VelocityCheck, DoesNotJudgeAnOldTrack) {
  Scene scene(-12.0);
  scene.track.history.first_seen_ns = kStartNs - 5'000'000'000;
  scene.check();
  EXPECT_EQ(scene.track.velocity_mps().y(), -12.0);
}

TEST(VelocityCheck, JudgesAnOldTrackWhoseVelocityIsKnownAgain) {
  Scene scene(-12.0);
  scene.track.history.first_seen_ns = kStartNs - 5'000'000'000;
  scene.track.existence.velocity_check.known_since_ns = kStartNs + 9 * kPeriodNs;
  scene.check();
  EXPECT_NEAR(scene.track.velocity_mps().y(), kSpeedMps, 2.5);
}

}  // namespace
}  // namespace slammot::tracking
