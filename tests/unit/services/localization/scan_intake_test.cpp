#include "services/localization/scan_intake.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::MappedWorld;
using Use = ScanIntake::Use;

/// A vehicle at 1 m/s through a room, with odometry at each scan, all of which are localized.
class ScanIntakeTest : public ::testing::Test {
 protected:
  static constexpr double kSpeed_mps = 1.0;

  explicit ScanIntakeTest(double period_s = 0.1) : period_s_(period_s) {
    for (; scan_ < 5; ++scan_) {
      const sensing::LaserScan scan = next_scan(pose());
      EXPECT_EQ(judge(scan), Use::kLocalized);
      intake_.accept(scan, prediction_);
      if (scan_ == 0) prediction_.begin(scan.stamp_ns);
      else
        prediction_.observe(prediction_.predict(scan.stamp_ns),
                            {.odom_from_base = {pose(), 1e-6 * geometry::Matrix3::Identity()},
                             .is_believed = true});
    }
  }

  Pose2 pose() const { return {kSpeed_mps * period_s_ * scan_, 0.0, 0.0}; }

  /// As seen from a pose; odometry comes with it.
  sensing::LaserScan next_scan(const Pose2& seen_from) {
    sensing::LaserScan scan = room_.scan_at(seen_from);
    scan.stamp_ns = to_ns(period_s_ * scan_);
    scan.sequence = static_cast<std::uint32_t>(scan_);
    prediction_.add({scan.stamp_ns, pose()});
    return scan;
  }

  Use judge(const sensing::LaserScan& scan) {
    return intake_.judge(scan, prediction_, room_.map(), counters_);
  }

  int scan_ = 0;
  double period_s_;
  MappedWorld room_{slammot::testing::room()};
  OdometryPrediction prediction_{LocalizerConfig{}};
  ScanIntake intake_{60.0};
  LocalizerCounters counters_;
};

TEST_F(ScanIntakeTest, DropsAndCountsWhatIsNotInItsOrder) {
  sensing::LaserScan scan = next_scan(pose());
  scan.stamp_ns = *prediction_.last_stamp_ns();
  EXPECT_EQ(judge(scan), Use::kDropped);
  scan.stamp_ns -= 1;
  EXPECT_EQ(judge(scan), Use::kDropped);
  scan.stamp_ns += to_ns(1000.0);
  EXPECT_EQ(judge(scan), Use::kDropped);
  EXPECT_EQ(counters_.scans.duplicate, 1U);
  EXPECT_EQ(counters_.scans.out_of_order, 1U);
  EXPECT_EQ(counters_.scans.far_ahead, 1U);
}

TEST_F(ScanIntakeTest, PredictsAScanThatMeasuresNothing) {
  sensing::LaserScan scan = next_scan(pose());
  for (float& range_m : scan.range_m) range_m = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(judge(scan), Use::kPredicted);
  EXPECT_EQ(counters_.scans.blank, 1U);
  EXPECT_EQ(counters_.scans.frozen, 0U);
  EXPECT_TRUE(intake_.accept_blank(scan));
  EXPECT_FALSE(intake_.accept_blank(scan)) << "a second time";
}

TEST_F(ScanIntakeTest, PredictsAScanThatRepeatsTheOneBeforeWhileOdometryMoves) {
  const Pose2 before{kSpeed_mps * period_s_ * (scan_ - 1), 0.0, 0.0};
  EXPECT_EQ(judge(next_scan(before)), Use::kPredicted);
  EXPECT_EQ(counters_.scans.frozen, 1U);
  EXPECT_EQ(counters_.scans.blank, 0U);
}

TEST_F(ScanIntakeTest, DeadReckonsWhereManyScansInARowMeasureNothing) {
  const auto judge_blank = [this] {
    sensing::LaserScan scan = next_scan(pose());
    for (float& range_m : scan.range_m) range_m = std::numeric_limits<float>::quiet_NaN();
    ++scan_;
    return judge(scan);
  };
  for (int blank = 0; blank < 9; ++blank) EXPECT_EQ(judge_blank(), Use::kPredicted) << blank;
  for (int blank = 9; blank < 12; ++blank) EXPECT_EQ(judge_blank(), Use::kWithoutReadings) << blank;
  EXPECT_EQ(counters_.scans.blank, 12U);
  EXPECT_EQ(judge(next_scan(pose())), Use::kLocalized);
  ++scan_;
  EXPECT_EQ(judge_blank(), Use::kPredicted) << "a few more";
}

TEST_F(ScanIntakeTest, PredictsManyScansWithoutBeams) {
  for (int empty = 0; empty < 20; ++empty) {
    sensing::LaserScan scan = next_scan(pose());
    scan.range_m.clear();
    ++scan_;
    EXPECT_EQ(judge(scan), Use::kPredicted) << empty;
  }
}

class RareScanIntake : public ScanIntakeTest {
 protected:
  RareScanIntake() : ScanIntakeTest(1.0) {}
};

TEST_F(RareScanIntake, LocalizesARepeatedScanWithoutItsReadings) {
  const Pose2 before{kSpeed_mps * period_s_ * (scan_ - 1), 0.0, 0.0};
  const sensing::LaserScan scan = next_scan(before);
  EXPECT_EQ(judge(scan), Use::kWithoutReadings);
  EXPECT_EQ(counters_.scans.frozen, 1U);
}

}  // namespace
}  // namespace slammot::localization
