#include "services/localization/pose_estimator.hpp"

#include <optional>

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::MappedWorld;
using slammot::testing::PoseNear;

/// A vehicle that stood in the middle of a mapped room at the scan before.
class PoseEstimatorTest : public ::testing::Test {
 protected:
  PoseEstimatorTest() {
    submaps_.begin();
    estimator_.add({0, Pose2::identity()});
    const sensing::LaserScan first = scan_from(Pose2::identity());
    estimator_.begin_scan({});
    estimator_.begin(first);
    submaps_.resume(submaps_.state(), room_.take_map());
  }

  sensing::LaserScan scan_from(const Pose2& pose) const {
    sensing::LaserScan scan = room_.scan_at(pose);
    scan.stamp_ns = stamp_ns_;
    return scan;
  }

  /// The next scan, 0.1 s later, seen from the pose; odometry, if any, has another one.
  bool place_at(const Pose2& pose, const std::optional<Pose2>& by_odometry) {
    stamp_ns_ += 100'000'000;
    if (by_odometry) estimator_.add({stamp_ns_, *by_odometry});
    const sensing::LaserScan scan = scan_from(pose);
    estimator_.begin_scan({});
    return place(scan);
  }

  bool place(const sensing::LaserScan& scan) {
    return estimator_.place({scan, {}, submaps_, integration_, counters_});
  }

  std::int64_t stamp_ns_ = 0;
  LocalizerConfig config_ = MappedWorld::config_of_small_map();
  MappedWorld room_{slammot::testing::room(), config_};
  PoseEstimator estimator_{config_};
  SubmapSequence submaps_{config_};
  ScanIntegration integration_{config_};
  LocalizerCounters counters_;
};

TEST_F(PoseEstimatorTest, PlacesAScanWhereItFitsTheMap) {
  const Pose2 true_pose{0.10, 0.02, 0.01};
  EXPECT_TRUE(place_at(true_pose, std::nullopt));
  EXPECT_THAT(estimator_.odom_from_base(), PoseNear(true_pose, 0.02));
  EXPECT_FALSE(estimator_.monitor().is_lost());
  EXPECT_EQ(counters_.matches.lost, 0U);
  EXPECT_EQ(counters_.odometry.missing, 1U);
}

TEST_F(PoseEstimatorTest, PlacesTheSameScanAgainAsBefore) {
  EXPECT_TRUE(place_at({0.10, 0.0, 0.0}, Pose2{0.10, 0.0, 0.0}));
  const PoseState before = estimator_.state();
  EXPECT_TRUE(place_at({0.20, 0.0, 0.0}, Pose2{0.20, 0.0, 0.0}));
  const Pose2 once = estimator_.odom_from_base();
  estimator_.set_state(before);
  EXPECT_NE(estimator_.odom_from_base(), once);
  EXPECT_TRUE(place(scan_from({0.20, 0.0, 0.0})));
  EXPECT_EQ(estimator_.odom_from_base(), once);
}

TEST_F(PoseEstimatorTest, DoesNotBelieveOdometryThatLeaps) {
  EXPECT_TRUE(place_at({0.10, 0.0, 0.0}, Pose2{0.10, 0.0, 0.0}));
  EXPECT_TRUE(place_at({0.20, 0.0, 0.0}, Pose2{40.0, 0.0, 0.0}));
  EXPECT_THAT(estimator_.odom_from_base(), PoseNear(Pose2{0.20, 0.0, 0.0}, 0.02));
  EXPECT_EQ(counters_.odometry.jumps, 1U);
  EXPECT_EQ(counters_.map.astray, 0U);
}

}  // namespace
}  // namespace slammot::localization
