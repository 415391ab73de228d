#include "services/detection/detector.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "services/detection/segment_description.hpp"
#include "tests/support/help_at_the_last_moment.hpp"
#include "tests/support/street.hpp"

namespace slammot::detection {
namespace {

using flow::PointLabel;
using testing::Street;
using testing::StreetBox;

const StreetBox kWall{{40.0, 0.0, M_PI / 2.0}, 80.0, 1.0};  // across the view, 39.5 m ahead

const flow::Segment* segment_at(const flow::SegmentedScan& scan, const geometry::Vector2& place_m,
                                double within_m) {
  for (const flow::Segment& segment : scan.segments)
    if ((segment.centroid_in_odom_m - place_m).norm() < within_m) return &segment;
  return nullptr;
}

TEST(Detector, LabelsObjectsInKnownFreeSpaceMoving) {
  Street street;
  street.known = {kWall};
  street.unknown = {{{20.0, 5.0, 0.3}}};
  const flow::SegmentedScan scan = detect(street.scan(0, 0), {});
  const flow::Segment* car = segment_at(scan, {20.0, 5.0}, 3.0);
  ASSERT_NE(car, nullptr);
  EXPECT_EQ(car->label, PointLabel::kMoving);
  const flow::Segment* wall = segment_at(scan, {39.5, -10.0}, 15.0);
  ASSERT_NE(wall, nullptr);
  EXPECT_EQ(wall->label, PointLabel::kStationary);
}

void expect_same(const flow::SegmentedScan& a, const flow::SegmentedScan& b) {
  EXPECT_EQ(a.points_in_base_m, b.points_in_base_m);
  EXPECT_EQ(a.range_m, b.range_m);
  EXPECT_EQ(a.labels, b.labels);
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    EXPECT_EQ(a.segments[i].segment_id, b.segments[i].segment_id);
    EXPECT_EQ(a.segments[i].label, b.segments[i].label);
    EXPECT_EQ(a.segments[i].beams, b.segments[i].beams);
    EXPECT_EQ(a.segments[i].box_length_m, b.segments[i].box_length_m);
    EXPECT_EQ(a.segments[i].moving_share, b.segments[i].moving_share);
    EXPECT_EQ(a.segments[i].occluded_at_start, b.segments[i].occluded_at_start);
  }
}

TEST(Detector, ReusesOnlyTheMemoryOfARecycledScan) {
  Street empty_street;
  empty_street.known = {kWall};
  Street full_street = empty_street;
  full_street.unknown = {{{20.0, 5.0, 0.3}}, {{12.0, -4.0, 1.2}}, {{30.0, 2.0, 0.0}}};
  const flow::LocalizedScan few = empty_street.scan(0, 0);
  const flow::LocalizedScan many = full_street.scan(100, 1);
  Detector detector{{}};
  expect_same(detector.detect(few, detector.detect(many)), detect(few, {}));
  expect_same(detector.detect(many, detector.detect(few)), detect(many, {}));
  flow::SegmentedScan recycled = detector.detect(many);
  const std::uint16_t* const beams = recycled.segments.front().beams.data();
  EXPECT_EQ(detector.detect(many, std::move(recycled)).segments.front().beams.data(), beams);
}

TEST(Detector, GivesTheSameResultInParallel) {
  Street street;
  street.known = {kWall};
  street.unknown = {
      {{20.0, 5.0, 0.3}}, {{12.0, -4.0, 1.2}}, {{30.0, 2.0, 0.0}}, {{15.0, 0.0, 0.0}}};
  const flow::LocalizedScan scan = street.scan(0, 0);
  slammot::testing::HelpAtTheLastMoment help;
  expect_same(Detector({}, &help).detect(scan), detect(scan, {}));
  EXPECT_GT(help.shared(), 0);
}

TEST(Detector, JoinsASegmentAcrossTheSeamOfAFullTurn) {
  Street street;
  street.look_all_round();
  street.known = {kWall, {{-40.0, 0.0, M_PI / 2.0}, 80.0, 1.0}};
  street.unknown = {{{-12.0, 0.0, M_PI / 2.0}}};
  const flow::SegmentedScan scan = detect(street.scan(0, 0), {});
  const flow::Segment* car = segment_at(scan, {-11.1, 0.0}, 0.5);
  ASSERT_NE(car, nullptr);
  EXPECT_EQ(car->label, PointLabel::kMoving);
  EXPECT_NEAR(car->box_length_m, 4.5, 0.2);
  EXPECT_GT(car->beams.front(), 690);
  EXPECT_LT(car->beams.back(), 30);
  EXPECT_FALSE(car->occluded_at_start);
  EXPECT_FALSE(car->occluded_at_end);
}

TEST(Detector, LabelsEchoesInUnseenSpaceUnknown) {
  Street street;
  street.known = {kWall};
  // A fence that occluded what is behind it and has been removed.
  street.gone = {{{15.0, 0.0, M_PI / 2.0}, 30.0, 1.0}};
  street.unknown = {{{22.0, 0.0, 0.0}}};
  const flow::SegmentedScan segmented = detect(street.scan(0, 0), {});
  const flow::Segment* car = segment_at(segmented, {20.0, 0.0}, 2.0);
  ASSERT_NE(car, nullptr);
  EXPECT_EQ(car->label, PointLabel::kUnknown);
}

TEST(Detector, TreatsAFalseEchoAsNone) {
  Street street;
  street.known = {kWall};
  Detector detector{{}};
  detector.detect(street.scan(0, 0));
  street.unknown = {{{1.5, 0.0, 0.0}, 0.02, 0.02}};  // a rain drop
  const flow::LocalizedScan raining = street.scan(100'000'000, 1);
  const flow::SegmentedScan scan = detector.detect(raining);
  int drops = 0;
  for (std::size_t beam = 0; beam < scan.labels.size(); ++beam) {
    EXPECT_NE(scan.labels[beam], PointLabel::kMoving) << beam;
    const float range_m = raining.beams[beam].range_m;
    if (range_m == 0.0F || range_m > 2.0F) continue;
    ++drops;
    EXPECT_EQ(scan.labels[beam], PointLabel::kNoEcho) << beam;
    EXPECT_EQ(scan.range_m[beam], 0.0F) << beam;
  }
  EXPECT_GT(drops, 0);
  EXPECT_EQ(segment_at(scan, {1.5, 0.0}, 0.5), nullptr);
}

TEST(Detector, PutsEveryEchoIntoExactlyOneSegment) {
  Street street;
  street.known = {kWall, {{12.0, -8.0, 0.2}}};
  street.unknown = {{{20.0, 5.0, 0.3}}, {{9.0, 2.0, 0.0}, 0.5, 0.5}};
  const flow::SegmentedScan scan = detect(street.scan(0, 0), {});
  std::vector<int> owners(scan.range_m.size(), 0);
  for (const flow::Segment& segment : scan.segments) {
    EXPECT_TRUE(std::is_sorted(segment.beams.begin(), segment.beams.end()));
    for (const std::uint16_t beam : segment.beams) ++owners[beam];
  }
  for (std::size_t beam = 0; beam < owners.size(); ++beam) {
    const bool is_echo = scan.range_m[beam] > 0.0F && scan.labels[beam] != PointLabel::kNoEcho;
    EXPECT_EQ(owners[beam], is_echo ? 1 : 0) << beam;
  }
}

TEST(Detector, SegmentsAPedestrianInFrontOfAWallSeparately) {
  Street street;
  street.known = {{{12.0, 0.0, M_PI / 2.0}, 30.0, 1.0}};  // its face is 11.5 m ahead
  street.unknown = {{{10.4, 0.0, 0.0}, 0.4, 0.5}};
  const flow::SegmentedScan segmented = detect(street.scan(0, 0), {});
  const flow::Segment* pedestrian = segment_at(segmented, {10.2, 0.0}, 0.3);
  ASSERT_NE(pedestrian, nullptr);
  EXPECT_EQ(pedestrian->label, PointLabel::kMoving);
  EXPECT_LT(pedestrian->box_length_m, 0.8);
}

/// Labels of the segments of two pedestrians 10 m ahead and of a post between them, 20 cm nearer
/// and this many beams wide.
std::vector<PointLabel> labels_around_a_post(double beams) {
  const double beam_m = 9.8 * M_PI / 360.0;
  const double half_m = 0.5 * beams * beam_m;
  Street street;
  street.known = {kWall, {{9.9, 0.0, M_PI / 2.0}, 2.0 * half_m, 0.2}};
  for (const double side : {-1.0, 1.0})
    street.unknown.push_back({{10.35, side * (half_m + 0.35), M_PI / 2.0}, 0.7, 0.2});
  std::vector<PointLabel> labels;
  for (const flow::Segment& segment : detect(street.scan(0, 0), {}).segments)
    if (segment.centroid_in_odom_m.x() < 12.0) labels.push_back(segment.label);
  return labels;
}

TEST(Detector, SeparatesStationaryPointsOfMoreThanTwoBeams) {
  using enum PointLabel;
  EXPECT_EQ(labels_around_a_post(2.0), (std::vector{kMoving}));
  EXPECT_EQ(labels_around_a_post(4.0), (std::vector{kMoving, kStationary, kMoving}));
}

TEST(Detector, MarksEndsOfSegmentsThatANearerObjectOccludes) {
  Street street;
  street.known = {kWall};
  // A pedestrian in front of a car seen from the side.
  street.unknown = {{{20.0, 0.0, M_PI / 2.0}}, {{10.0, -0.5, 0.0}, 0.4, 0.5}};
  const flow::SegmentedScan scan = detect(street.scan(0, 0), {});
  const flow::Segment* right = segment_at(scan, {19.1, -1.85}, 0.2);
  const flow::Segment* left = segment_at(scan, {19.1, 0.9}, 0.2);
  ASSERT_NE(left, nullptr);
  EXPECT_TRUE(left->occluded_at_start);
  EXPECT_FALSE(left->occluded_at_end);
  ASSERT_NE(right, nullptr);
  ASSERT_NE(right, left);
  EXPECT_TRUE(right->occluded_at_end);
  EXPECT_FALSE(right->occluded_at_start);
}

/// A pedestrian 12 m ahead in unseen space, where the MO-map holds this evidence.
flow::LocalizedScan scan_of_pedestrian(float moving_evidence, double width_m = 0.5) {
  Street street;
  street.knows_the_open = false;
  street.unknown = {{{12.0, 0.0, M_PI / 2.0}, width_m, 0.5}};
  flow::LocalizedScan scan = street.scan(0, 0);
  for (flow::LocalizedBeam& beam : scan.beams) beam.moving_evidence = moving_evidence;
  return scan;
}

PointLabel label_of_pedestrian(float moving_evidence, double width_m = 0.5) {
  const flow::SegmentedScan scan = detect(scan_of_pedestrian(moving_evidence, width_m), {});
  const flow::Segment* pedestrian = segment_at(scan, {11.75, 0.0}, 0.2);
  return pedestrian == nullptr ? PointLabel::kNoEcho : pedestrian->label;
}

TEST(Detector, LabelsUnknownPointsMovingWhereTheMoMapHasEvidence) {
  const auto least = static_cast<float>(kLeastMovingEvidence);
  EXPECT_EQ(label_of_pedestrian(0.0F), PointLabel::kUnknown);
  EXPECT_EQ(label_of_pedestrian(0.9F * least), PointLabel::kUnknown);
  EXPECT_EQ(label_of_pedestrian(1.1F * least), PointLabel::kMoving);
  EXPECT_EQ(label_of_pedestrian(0.5F), PointLabel::kMoving) << "motion in every other observation";
}

TEST(Detector, LabelsOnlySmallSegmentsByTheMoMap) {
  constexpr int most = 12;  // echoes: a pedestrian 5 m away, no wall
  const double beam_m = 11.75 * M_PI / 360.0;
  EXPECT_EQ(label_of_pedestrian(1.0F, (most - 2) * beam_m), PointLabel::kMoving);
  EXPECT_EQ(label_of_pedestrian(1.0F, (most + 3) * beam_m), PointLabel::kUnknown);
}

TEST(Detector, AveragesTheEvidenceOfTheMoMapOverASegment) {
  const auto least = static_cast<float>(kLeastMovingEvidence);
  flow::LocalizedScan scan = scan_of_pedestrian(0.0F);
  int echoes = 0;
  for (const flow::LocalizedBeam& beam : scan.beams) echoes += beam.range_m > 0.0F ? 1 : 0;
  flow::LocalizedBeam& one = *std::ranges::find_if(
      scan.beams, [](const flow::LocalizedBeam& beam) { return beam.range_m > 0.0F; });
  one.moving_evidence = 0.9F * least * static_cast<float>(echoes);
  EXPECT_EQ(detect(scan, {}).segments.front().label, PointLabel::kUnknown);
  one.moving_evidence = 1.1F * least * static_cast<float>(echoes);
  EXPECT_EQ(detect(scan, {}).segments.front().label, PointLabel::kMoving);
}

TEST(Detector, LabelsAKnownPostStationaryDespiteMovingEvidence) {
  Street street;
  street.known = {{{12.0, 0.0, M_PI / 2.0}, 0.5, 0.5}};
  flow::LocalizedScan scan = street.scan(0, 0);
  for (flow::LocalizedBeam& beam : scan.beams) beam.moving_evidence = 1.0F;
  const flow::SegmentedScan segmented = detect(scan, {});
  const flow::Segment* post = segment_at(segmented, {11.75, 0.0}, 0.2);
  ASSERT_NE(post, nullptr);
  EXPECT_EQ(post->label, PointLabel::kStationary);
}

geometry::Matrix2 covariance_of_a_car(const Eigen::Vector3d& variances_of_pose,
                                      double local_variance_share = 1.0) {
  Street street;
  street.known = {kWall};
  street.unknown = {{{20.0, 0.0, M_PI / 2.0}}};
  flow::LocalizedScan scan = street.scan(0, 0);
  scan.odom_from_base.covariance = variances_of_pose.asDiagonal();
  scan.local_variance_share = local_variance_share;
  const flow::SegmentedScan segmented = detect(scan, {});
  const flow::Segment* car = segment_at(segmented, {19.1, 0.0}, 0.5);
  return car == nullptr ? geometry::Matrix2(geometry::Matrix2::Zero())
                        : car->centroid_covariance_m2;
}

TEST(Detector, AddsThePosesCovarianceToThatOfASegment) {
  const geometry::Matrix2 by_scanner = covariance_of_a_car({0.0, 0.0, 0.0});
  const geometry::Matrix2 by_pose = covariance_of_a_car({0.04, 0.09, 0.0}) - by_scanner;
  EXPECT_GT(by_scanner.trace(), 0.0);
  EXPECT_NEAR(by_pose(0, 0), 0.04, 1e-6);
  EXPECT_NEAR(by_pose(1, 1), 0.09, 1e-6);
  const geometry::Matrix2 by_heading = covariance_of_a_car({0.0, 0.0, 1e-4}) - by_scanner;
  EXPECT_NEAR(by_heading(0, 0), 0.0, 1e-6);
  EXPECT_NEAR(by_heading(1, 1), 1e-4 * 19.1 * 19.1, 1e-3);  // at the end of the lever
}

/// Monte Carlo, of a usual scanner: 3 cm, and 1 mm more for each metre.
TEST(Detector, PredictsHowACentroidScattersWithTheNoiseOfRanges) {
  constexpr int kScans = 500;
  constexpr double kCarX_m = 19.1;
  Street street;
  street.known = {kWall};
  street.unknown = {{{20.0, 0.0, M_PI / 2.0}}};
  std::mt19937_64 random(2);
  std::normal_distribution<float> noise;
  double squares_m2 = 0.0;
  double predicted_m2 = 0.0;
  for (int i = 0; i < kScans; ++i) {
    flow::LocalizedScan scan = street.scan(0, 0);
    for (flow::LocalizedBeam& beam : scan.beams) {
      if (beam.range_m == 0.0F) continue;
      const float error_m = (0.03F + 0.001F * beam.range_m) * noise(random);
      beam.point_in_base_m *= 1.0F + error_m / beam.range_m;
      beam.range_m += error_m;
    }
    scan.odom_from_base.covariance.setZero();
    const flow::SegmentedScan segmented = detect(scan, {});
    const flow::Segment* car = segment_at(segmented, {kCarX_m, 0.0}, 0.5);
    ASSERT_NE(car, nullptr);
    squares_m2 += std::pow(car->centroid_in_odom_m.x() - kCarX_m, 2);
    predicted_m2 += car->centroid_covariance_m2(0, 0);
  }
  EXPECT_NEAR(squares_m2 / predicted_m2, 1.0, 0.25);
}

TEST(Detector, UsesTheShareOfThePosesVarianceRelativeToTheLocalMap) {
  const geometry::Matrix2 by_scanner = covariance_of_a_car({0.0, 0.0, 0.0});
  EXPECT_NEAR((covariance_of_a_car({0.04, 0.09, 0.0}, 0.25) - by_scanner)(1, 1), 0.25 * 0.09, 1e-6);
}

/// A thin line square to the vehicle's axis.
StreetBox line_ahead(double distance_m, double width_m) {
  return {{distance_m, 0.0, M_PI / 2.0}, width_m, 0.1};
}

TEST(Detector, LabelsALineWithNothingBeyondItAsGround) {
  Street street;
  street.known = {kWall};
  // As wide as the view: echoes of a pitching scanner.
  street.unknown = {line_ahead(15.0, 200.0)};
  const flow::SegmentedScan scan = detect(street.scan(0, 0), {});
  EXPECT_EQ(scan.labels[180], PointLabel::kNoEcho);
  EXPECT_EQ(segment_at(scan, {14.95, 0.0}, 5.0), nullptr);
}

TEST(Detector, LabelsALineBetweenHousesAsGroundThoughMostBeamsHaveNoEcho) {
  Street street;
  street.known = {{{12.0, 4.5, 0.0}, 8.0, 2.0}, {{12.0, -4.5, 0.0}, 8.0, 2.0}};
  street.unknown = {line_ahead(15.0, 12.0)};  // asphalt beside the houses returns no echo
  const flow::SegmentedScan scan = detect(street.scan(0, 0), {});
  ASSERT_GT(scan.range_m[180], 0.0F);
  EXPECT_EQ(scan.labels[180], PointLabel::kNoEcho);
}

TEST(Detector, DoesNotLabelACrossingBusAsGround) {
  Street street;
  street.unknown = {{{16.25, 0.0, M_PI / 2.0}, 12.0, 2.5}};
  const flow::SegmentedScan segmented = detect(street.scan(0, 0), {});
  const flow::Segment* bus = segment_at(segmented, {15.0, 0.0}, 0.5);
  ASSERT_NE(bus, nullptr);
  EXPECT_EQ(bus->label, PointLabel::kMoving);
}

PointLabel label_of_a_crossing_body(double length_m, const DetectionConfig& config) {
  Street street;
  street.known = {kWall};
  street.unknown = {{{16.25, 0.0, M_PI / 2.0}, length_m, 2.5}};
  const flow::SegmentedScan scan = detect(street.scan(0, 0), config);
  const flow::Segment* body = segment_at(scan, {15.0, 0.0}, 0.5);
  return body == nullptr ? PointLabel::kNoEcho : body->label;
}

TEST(Detector, LeavesOpenWhetherMovesWhatIsLongerThanARoadUser) {
  EXPECT_EQ(label_of_a_crossing_body(14.0, {}), PointLabel::kMoving);
  EXPECT_EQ(label_of_a_crossing_body(20.0, {}), PointLabel::kUnknown);
  EXPECT_EQ(label_of_a_crossing_body(20.0, {.longest_mover_m = 22.0}), PointLabel::kMoving)
      << "a tram, where the site has them";
}

TEST(Detector, DoesNotLabelTheBackOfATruckAsGround) {
  Street street;
  street.known = {kWall};
  // Its back is 15 m ahead; beams pass it on both sides.
  street.unknown = {{{18.5, 0.0, 0.0}, 7.0, 2.5}};
  const flow::SegmentedScan segmented = detect(street.scan(0, 0), {});
  const flow::Segment* truck = segment_at(segmented, {15.0, 0.0}, 0.5);
  ASSERT_NE(truck, nullptr);
  EXPECT_EQ(truck->label, PointLabel::kMoving);
}

/// An object 1 m wide at this distance in front of a wall.
PointLabel label_in_front_of_a_wall(double wall_m, double in_front_m) {
  Street street;
  street.known = {{{wall_m + 0.5, 0.0, M_PI / 2.0}, 80.0, 1.0}};
  street.unknown = {{{wall_m - in_front_m + 0.05, 0.0, M_PI / 2.0}, 1.0, 0.1}};
  return detect(street.scan(0, 0), {}).labels[180];
}

TEST(Detector, LabelsEchoesWithinTheErrorOfAWallStationary) {
  EXPECT_EQ(label_in_front_of_a_wall(10.0, 0.33), PointLabel::kStationary);
  EXPECT_EQ(label_in_front_of_a_wall(10.0, 0.45), PointLabel::kMoving);
  EXPECT_EQ(label_in_front_of_a_wall(50.0, 0.45), PointLabel::kStationary);
  EXPECT_EQ(label_in_front_of_a_wall(50.0, 0.75), PointLabel::kMoving);
}

/// True if the right end of a car's side, 8 m ahead, is labelled occluded by a pedestrian at this
/// distance in front of it.
bool is_occluded_by_pedestrian(double in_front_m) {
  Street street;
  street.known = {kWall};
  // Face of the occluder, right of the car's right end.
  const double near_m = 8.0 - in_front_m;
  street.unknown = {{{8.9, 0.0, M_PI / 2.0}}, {{near_m + 0.2, -2.4 * near_m / 8.0, 0.0}, 0.4, 0.5}};
  const flow::SegmentedScan scan = detect(street.scan(0, 0), {});
  for (const flow::Segment& segment : scan.segments)
    if (std::abs(segment.centroid_in_odom_m.x() - 8.0) < 0.05) return segment.occluded_at_start;
  ADD_FAILURE() << "no segment of the car behind a pedestrian " << in_front_m
                << " m in front of it";
  return false;
}

TEST(Detector, MarksAnEndAsOccludedByAnObjectClearlyInFrontOfIt) {
  EXPECT_TRUE(is_occluded_by_pedestrian(2.0));
  EXPECT_TRUE(is_occluded_by_pedestrian(0.8));
}

TEST(Detector, DoesNotLabelACarThatFillsANarrowLaneAsGround) {
  Street street;
  // Houses occlude everything beside it.
  street.known = {{{12.0, 5.95, 0.0}, 8.0, 10.0}, {{12.0, -5.95, 0.0}, 8.0, 10.0}};
  street.unknown = {{{17.5, 0.0, 0.0}}};
  const flow::SegmentedScan scan = detect(street.scan(0, 0), {});
  const flow::Segment* car = segment_at(scan, {15.25, 0.0}, 0.5);
  ASSERT_NE(car, nullptr);
  EXPECT_EQ(car->label, PointLabel::kMoving);
}

PointLabel label_ahead_of_a_line(const geometry::Pose2& odom_from_line) {
  Street street;
  street.known = {kWall};
  street.unknown = {{odom_from_line, 200.0, 0.1}};
  return detect(street.scan(0, 0), {}).labels[180];
}

TEST(Detector, LabelsAsGroundOnlyALineSquareToTheAxisAndBeyondTheLeastDistance) {
  constexpr double kHeadingRad = 0.25;
  constexpr double kNearestM = 3.0;
  const double square_rad = M_PI / 2.0;
  EXPECT_EQ(label_ahead_of_a_line({15.0, 0.0, square_rad + 0.8 * kHeadingRad}),
            PointLabel::kNoEcho);
  EXPECT_EQ(label_ahead_of_a_line({15.0, 0.0, square_rad + 1.3 * kHeadingRad}),
            PointLabel::kMoving);
  EXPECT_EQ(label_ahead_of_a_line({15.0, 0.0, square_rad - 1.3 * kHeadingRad}),
            PointLabel::kMoving);
  EXPECT_EQ(label_ahead_of_a_line({1.2 * kNearestM, 0.0, square_rad}), PointLabel::kNoEcho);
  EXPECT_EQ(label_ahead_of_a_line({0.8 * kNearestM, 0.0, square_rad}), PointLabel::kMoving);
}

TEST(Detector, MovesWithTheWorld) {
  Street street;
  street.known = {kWall};
  street.unknown = {{{20.0, 5.0, 0.3}}};
  const flow::SegmentedScan here = detect(street.scan(0, 0), {});
  const geometry::Pose2 there_from_here{100.0, -50.0, 0.7};
  for (auto* boxes : {&street.known, &street.unknown})
    for (StreetBox& box : *boxes) box.odom_from_box = there_from_here * box.odom_from_box;
  const flow::SegmentedScan there = detect(street.scan(0, 0, there_from_here), {});
  ASSERT_EQ(there.segments.size(), here.segments.size());
  for (std::size_t i = 0; i < here.segments.size(); ++i) {
    EXPECT_EQ(there.segments[i].label, here.segments[i].label);
    EXPECT_LT((there.segments[i].centroid_in_odom_m -
               there_from_here * here.segments[i].centroid_in_odom_m)
                  .norm(),
              1e-3);
    EXPECT_NEAR(there.segments[i].box_length_m, here.segments[i].box_length_m, 0.05);
  }
}

}  // namespace
}  // namespace slammot::detection
