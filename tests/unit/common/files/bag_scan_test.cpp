#include "common/files/bag_scan.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::files {
namespace {

using geometry::Pose2;
using std::numbers::pi;
using testing::PoseNear;

bags::Transform rotated(const Eigen::Quaterniond& rotation) {
  return {Eigen::Vector3d(0.3, 0.1, 0.5), rotation};
}
Eigen::Quaterniond about(const Eigen::Vector3d& axis, double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis));
}

BeamLayout layout(double first_rad, double step_rad, std::size_t beams) {
  const auto known =
      layout_of_message(static_cast<float>(first_rad),
                        static_cast<float>(first_rad + step_rad * static_cast<double>(beams - 1)),
                        static_cast<float>(step_rad), beams);
  EXPECT_TRUE(known);
  return known.value_or(BeamLayout{});
}

TEST(HeadingAsWritten, IsTheDecimalThatWentThroughAQuaternion) {
  for (int i = -3'141'592; i <= 3'141'592; i += 9'973) {
    const double written_rad = static_cast<double>(i) / 1e6;
    EXPECT_EQ(planar({Eigen::Vector3d::Zero(),
                      {std::cos(written_rad / 2), 0.0, 0.0, std::sin(written_rad / 2)}})
                  .heading_rad,
              written_rad);
  }
}

TEST(HeadingAsWritten, IsTheDecimalAlsoWhereItGoesOnBeyondATurn) {
  for (const double written_rad : {7.123456, -12.345678, 31.000001, 3.5}) {
    const bags::Transform pose{Eigen::Vector3d::Zero(),
                               {std::cos(written_rad / 2), 0.0, 0.0, std::sin(written_rad / 2)}};
    EXPECT_EQ(planar(pose).heading_rad, geometry::wrap_angle(written_rad)) << written_rad;
  }
}

TEST(HeadingAsWritten, LeavesOtherNumbersAlone) {
  EXPECT_EQ(heading_as_written(1.0 / 3.0), 1.0 / 3.0);
}

TEST(LayoutOfMessage, IsThatOfFlaserToTheLastBit) {
  for (const std::size_t beams : {180U, 181U, 360U, 361U, 720U, 721U}) {
    const BeamLayout expected = layout_by_convention(beams, pi);
    const BeamLayout known = layout(expected.first_beam_rad, expected.beam_step_rad, beams);
    EXPECT_EQ(known.first_beam_rad, expected.first_beam_rad) << beams;
    EXPECT_EQ(known.beam_step_rad, expected.beam_step_rad) << beams;
  }
}

TEST(LayoutOfMessage, IsThatOfRobotLaserToTheLastBitHoweverItWasConverted) {
  const auto expected = layout_of_record(-1.570796, 3.141593, 0.008727, 361);
  for (const double step_rad : {0.008727, 3.141593 / 360.0, pi / 360.0}) {
    const BeamLayout known = layout(-1.570796, step_rad, 361);
    EXPECT_EQ(known.first_beam_rad, expected->first_beam_rad) << step_rad;
    EXPECT_EQ(known.beam_step_rad, expected->beam_step_rad) << step_rad;
  }
}

TEST(LayoutOfMessage, MayGoClockwise) {
  const BeamLayout known = layout(pi / 2.0, -pi / 180.0, 181);
  EXPECT_EQ(known.first_beam_rad, pi / 2.0);
  EXPECT_EQ(known.beam_step_rad, -pi / 180.0);
}

TEST(LayoutOfMessage, TakesTheSignOfItsEndsWhereTheyAgreeWithItsStep) {
  constexpr float kQuarter = static_cast<float>(pi / 2.0);
  constexpr float kDegree = static_cast<float>(pi / 180.0);
  EXPECT_EQ(layout_of_message(-kQuarter, kQuarter, -kDegree, 181)->beam_step_rad, pi / 180.0);
  EXPECT_EQ(layout_of_message(kQuarter, -kQuarter, kDegree, 181)->beam_step_rad, -pi / 180.0);
  EXPECT_EQ(layout_of_message(kQuarter, -kQuarter, -kDegree, 181)->beam_step_rad, -pi / 180.0);
  // The ends contradict the size of the step: they are not believed.
  EXPECT_EQ(layout_of_message(kQuarter, kQuarter / 2.0F, kDegree, 181)->beam_step_rad, pi / 180.0);
  EXPECT_EQ(layout_of_message(-kQuarter, NAN, kDegree, 181)->beam_step_rad, pi / 180.0);
}

TEST(LayoutOfMessage, StaysWithinTheRoundingOfWhateverItIsGiven) {
  for (const double first_rad : {-2.0943951, -2.35619, 0.0, -1.2345678}) {
    for (const double step_rad : {0.0043633, 0.00123, 0.005774, 0.017}) {
      const BeamLayout known = layout(first_rad, step_rad, 200);
      EXPECT_NEAR(known.first_beam_rad, first_rad, 2e-7);
      EXPECT_NEAR(known.beam_step_rad, step_rad, 3e-9);
    }
  }
}

TEST(LayoutOfMessage, RefusesWhatMakesNoSense) {
  EXPECT_FALSE(layout_of_message(NAN, 1.0F, 0.1F, 10));
  EXPECT_FALSE(layout_of_message(0.0F, 1.0F, INFINITY, 10));
  EXPECT_FALSE(layout_of_message(0.0F, 1.0F, 0.1F, 1));
  EXPECT_FALSE(layout_of_message(0.0F, 100.0F, 0.1F, 1000));
  EXPECT_FALSE(layout_of_message(0.0F, 0.0F, 0.0F, 100));
}

TEST(MountingOf, SeesAScannerThatLooksBackwards) {
  const Mounting mounting = mounting_of(rotated(about(Eigen::Vector3d::UnitZ(), pi)));
  EXPECT_THAT(mounting.base_from_laser, PoseNear(Pose2{0.3, 0.1, pi}, 1e-12));
  EXPECT_FALSE(mounting.is_upside_down);
}

TEST(MountingOf, SeesAScannerThatHangsUpsideDown) {
  const Mounting mounting = mounting_of(
      rotated(about(Eigen::Vector3d::UnitZ(), 0.5) * about(Eigen::Vector3d::UnitX(), pi)));
  EXPECT_NEAR(mounting.base_from_laser.heading_rad, 0.5, 1e-9);
  EXPECT_TRUE(mounting.is_upside_down);
  EXPECT_NEAR(mounting.tilt_rad, 0.0, 1e-6);
}

TEST(MountingOf, SaysHowFarAScannerIsTilted) {
  EXPECT_NEAR(mounting_of(rotated(about(Eigen::Vector3d::UnitY(), 0.2))).tilt_rad, 0.2, 1e-9);
}

TEST(RecordOfScan, TakesReadingsBelowTheLeastRangeForNoEcho) {
  const auto record = record_of(bags::LaserScanMessage{.first_beam_rad = 0.0F,
                                                       .last_beam_rad = 0.2F,
                                                       .beam_step_rad = 0.1F,
                                                       .least_range_m = 0.5F,
                                                       .most_range_m = 10.0F,
                                                       .range_m = {0.4F, 0.5F, 11.0F}});
  ASSERT_TRUE(record);
  EXPECT_THAT(record->range_m, ::testing::ElementsAre(0.0F, 0.5F, 11.0F));
  EXPECT_EQ(record->max_range_m, 10.0);
}

TEST(RecordOfCloud, KeepsTheNearestPointOfTheSliceInEachDirection) {
  const bags::PointCloudMessage cloud{
      {}, {{5.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 0.05F}, {1.0F, 0.0F, 2.0F}, {0.0F, -4.0F, 0.0F}}};
  const LaserRecord record =
      record_of(cloud, rotated(Eigen::Quaterniond::Identity()), {0.3, 0.7, 4});
  EXPECT_EQ(record.base_from_laser, (Pose2{0.3, 0.1, 0.0}));
  EXPECT_THAT(record.range_m,
              ::testing::ElementsAre(0.0F, 4.0F, ::testing::FloatNear(3.0F, 1e-6F), 0.0F));
}

}  // namespace
}  // namespace slammot::files
