#include "services/evaluator/annotations.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using geometry::Vector2;

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// Ten seconds at 1 m/s along x, a pose every 0.1 s.
RunResult straight_drive() {
  RunResult result;
  for (int i = 0; i <= 100; ++i) result.online.push_back({i * kSecondNs / 10, {0.1 * i, 0.0, 0.0}});
  return result;
}

metrics::TrueObject person(std::size_t index, double x_m, double y_m) {
  metrics::TrueObject person;
  person.object = index;
  person.world_from_object = {x_m, y_m, 0.0};
  return person;
}

TEST(PlaceAnnotations, InterpolatesPeopleBetweenTheirSightings) {
  Truth truth;
  truth.annotated = {{{2 * kSecondNs, {person(0, 5.0, 0.0)}},
                      {2 * kSecondNs + kSecondNs / 2, {person(0, 4.5, 1.0)}}}};  // crosses: x in
                                                                                 // map stays
  const Truth placed = place_annotations(truth, straight_drive(), 3);
  EXPECT_EQ(placed.trajectory.front().stamp_ns, 2 * kSecondNs);
  EXPECT_EQ(placed.trajectory.back().stamp_ns, 2 * kSecondNs + kSecondNs / 2);
  ASSERT_FALSE(placed.objects->empty());
  for (const ObjectsAt& at : *placed.objects) {
    ASSERT_EQ(at.objects.size(), 1U);
    EXPECT_NEAR(at.objects[0].world_from_object.x_m, 7.0, 1e-9);
    EXPECT_NEAR(at.objects[0].world_from_object.y_m,
                2.0 * static_cast<double>(at.stamp_ns - 2 * kSecondNs) / kSecondNs, 1e-9);
    EXPECT_NEAR(at.objects[0].speed_mps, 2.0, 1e-9);
  }
}

TEST(PlaceAnnotations, TransformsPeopleFromTheLasersFrame) {
  RunResult result = straight_drive();
  result.base_from_laser = {0.5, 0.0, 0.5 * std::numbers::pi};
  Truth truth;
  truth.annotated = {{{2 * kSecondNs, {person(0, 3.0, 0.0)}},
                      {2 * kSecondNs + kSecondNs / 2, {person(0, 3.0, 0.5)}}}};  // stands left of
                                                                                 // the path
  const Truth placed = place_annotations(truth, result, 3);
  ASSERT_FALSE(placed.objects->empty());
  for (const ObjectsAt& at : *placed.objects) {
    EXPECT_NEAR(at.objects.at(0).world_from_object.x_m, 2.5, 1e-9);
    EXPECT_NEAR(at.objects.at(0).world_from_object.y_m, 3.0, 1e-9);
  }
}

TEST(PlaceAnnotations, OmitsPeopleBetweenDistantSightings) {
  Truth truth;
  truth.annotated = {
      {{2 * kSecondNs, {person(0, 5.0, 0.0)}}, {4 * kSecondNs, {person(0, 3.0, 0.0)}}}};
  const Truth placed = place_annotations(truth, straight_drive(), 3);
  EXPECT_TRUE(placed.objects->empty());
  EXPECT_EQ(placed.trajectory.size(), 21U);  // tracks in these scans count as false
}

TEST(PlaceAnnotations, UsesTheAnnotatedScan) {
  constexpr std::int64_t kLateNs = 60'000'000;  // annotated between that scan and the next
  Truth truth;
  truth.annotated = {{{2 * kSecondNs + kLateNs, {person(0, 5.0, 0.0)}},
                      {2 * kSecondNs + kSecondNs / 2 + kLateNs, {person(0, 4.5, 0.0)}}}};  // stands
  const Truth placed = place_annotations(truth, straight_drive(), 3);
  ASSERT_EQ(placed.objects->size(), 6U);
  EXPECT_EQ(placed.objects->front().stamp_ns, 2 * kSecondNs);
  for (const ObjectsAt& at : *placed.objects) {
    EXPECT_NEAR(at.objects.at(0).world_from_object.x_m, 7.0, 1e-9);
    EXPECT_NEAR(at.objects.at(0).speed_mps, 0.0, 1e-9);
  }
}

TEST(PlaceAnnotations, DoesNotRequirePeopleInScansWithoutAnnotation) {
  Truth truth;
  truth.annotated = {{{2 * kSecondNs, {person(0, 5.0, 0.0)}},
                      {2 * kSecondNs + kSecondNs / 2, {person(0, 4.5, 0.0)}}}};
  const Truth placed = place_annotations(truth, straight_drive(), 3);
  ASSERT_EQ(placed.objects->size(), 6U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(placed.objects->at(i).objects.at(0).points, i == 0 || i == 5 ? 3 : 0);
}

TEST(PlaceAnnotations, SmoothsTheNoiseOfAnnotations) {
  Truth truth;
  truth.annotated.emplace();
  for (int i = 0; i <= 10; ++i)
    truth.annotated->push_back(
        {2 * kSecondNs + i * kSecondNs / 10, {person(0, 5.0 - 0.1 * i, i % 2 == 0 ? 0.1 : -0.1)}});
  const Truth placed = place_annotations(truth, straight_drive(), 3);
  ASSERT_FALSE(placed.objects->empty());
  for (const ObjectsAt& at : *placed.objects) EXPECT_LT(at.objects.at(0).speed_mps, 0.2);
}

TEST(ReadTruth, TakesAnnotationsOfAFolder) {
  const testing::TemporaryFolder folder;
  write(folder / "people_gt.txt",
        "# bag_time person_id x y (laser frame)\n10.5 1 4.0 -2.0\n10.5 1000 2.0 1.0\n10.6 1 3.9 "
        "-2.0\n");
  const auto truth = read_truth(folder.path());
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_EQ(truth->object_count, 2U);
  ASSERT_TRUE(truth->annotated);
  ASSERT_EQ(truth->annotated->size(), 2U);
  EXPECT_EQ(truth->annotated->at(0).objects.size(), 2U);
  EXPECT_EQ(truth->annotated->at(1).objects[0].object, truth->annotated->at(0).objects[0].object);
}

}  // namespace
}  // namespace slammot::evaluator
