#include "services/detection/clutter.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace slammot::detection {
namespace {

constexpr std::size_t kBeams = 181;
constexpr double kPeriodS = 0.2;

/// A semicircular wall 6 m away, without anything else; scans at the origin of odom, five a second.
class ClutterTest : public ::testing::Test {
 protected:
  flow::SegmentedScan scan() {
    flow::SegmentedScan scan;
    scan.scanner_id = "front";
    scan.stamp_ns = static_cast<std::int64_t>(1e9 * kPeriodS * scans_++);
    scan.beam_step_rad = std::numbers::pi / (kBeams - 1);
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      scan.points_in_base_m.emplace_back();
      scan.range_m.push_back(0.0F);
      scan.labels.push_back(flow::PointLabel::kStationary);
      put(beam, 6.0, scan);
      scan.labels[beam] = flow::PointLabel::kStationary;
    }
    return scan;
  }

  static void put(std::size_t beam, double range_m, flow::SegmentedScan& scan) {
    const double angle_rad = static_cast<double>(beam) * scan.beam_step_rad - std::numbers::pi / 2;
    scan.range_m[beam] = static_cast<float>(range_m);
    scan.labels[beam] = flow::PointLabel::kMoving;
    scan.points_in_base_m[beam] =
        Eigen::Vector2d(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)).cast<float>();
  }

  std::vector<std::size_t> false_echoes(const flow::SegmentedScan& scan) {
    std::vector<char> is_clutter;
    clutter_.find(scan, scan.range_m, is_clutter);
    std::vector<std::size_t> found;
    for (std::size_t beam = 0; beam < is_clutter.size(); ++beam)
      if (is_clutter[beam]) found.push_back(beam);
    return found;
  }

  Clutter clutter_;
  int scans_ = 0;
};

using Beams = std::vector<std::size_t>;

TEST_F(ClutterTest, IsAnEchoOfSomethingTooThinThatWasNotThereBefore) {
  EXPECT_EQ(false_echoes(scan()), Beams{});
  flow::SegmentedScan with_three = scan();
  put(30, 0.5, with_three), put(90, 2.0, with_three), put(120, 1.2, with_three);
  EXPECT_EQ(false_echoes(with_three), (Beams{30, 90, 120}));
}

TEST_F(ClutterTest, IsNoneWhereTheMapHasNotSeenThrough) {
  false_echoes(scan());
  flow::SegmentedScan with_one = scan();
  put(90, 2.0, with_one);
  with_one.labels[90] = flow::PointLabel::kUnknown;
  EXPECT_EQ(false_echoes(with_one), Beams{});
}

TEST_F(ClutterTest, IsNoneThatMayComeFromALeg) {
  false_echoes(scan());
  flow::SegmentedScan far = scan();
  put(90, 3.0, far);  // 0.1 m between the beams that pass
  EXPECT_EQ(false_echoes(far), Beams{});
  flow::SegmentedScan wide = scan();
  put(90, 1.5, wide), put(91, 1.5, wide);
  EXPECT_EQ(false_echoes(wide), Beams{});
}

TEST_F(ClutterTest, IsNoneThatMayGoOnBehindWhatIsNearer) {
  false_echoes(scan());
  flow::SegmentedScan at_an_edge = scan();
  for (std::size_t beam = 91; beam < 100; ++beam) put(beam, 1.0, at_an_edge);
  put(90, 2.0, at_an_edge);
  EXPECT_EQ(false_echoes(at_an_edge), Beams{});
}

TEST_F(ClutterTest, IsNoneOfWhatIsThinAndStands) {
  flow::SegmentedScan chair = scan();
  put(90, 2.0, chair);
  false_echoes(chair);
  flow::SegmentedScan again = scan();
  put(91, 2.02, again);
  EXPECT_EQ(false_echoes(again), Beams{});
}

TEST_F(ClutterTest, IsAnEchoBesideTheOneThatWasThereBefore) {
  flow::SegmentedScan chair = scan();
  put(90, 2.0, chair);
  false_echoes(chair);
  flow::SegmentedScan with_two = scan();
  put(90, 2.0, with_two), put(92, 2.0, with_two);
  EXPECT_EQ(false_echoes(with_two), (Beams{90, 92})) << "which of them came is not known";
}

TEST_F(ClutterTest, IsSoughtBetweenBeamsWithoutEcho) {
  false_echoes(scan());
  flow::SegmentedScan sparse = scan();
  sparse.range_m[89] = sparse.range_m[91] = 0.0F;
  put(90, 1.0, sparse);
  EXPECT_EQ(false_echoes(sparse), Beams{90});
}

TEST_F(ClutterTest, IsNotSoughtInTheFirstScanOfAScanner) {
  false_echoes(scan());
  flow::SegmentedScan of_another = scan();
  of_another.scanner_id = "rear";
  put(90, 1.0, of_another);
  EXPECT_EQ(false_echoes(of_another), Beams{});
}

}  // namespace
}  // namespace slammot::detection
