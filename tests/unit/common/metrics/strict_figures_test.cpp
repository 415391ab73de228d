#include "common/metrics/strict_figures.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "common/metrics/box_overlap.hpp"
#include "tests/unit/common/metrics/scenes.hpp"

namespace slammot::metrics {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
const CountingRule kRule;

TEST(IntersectionOverUnion, IsThatOfShiftedAndTurnedBoxes) {
  const Box box{{0.0, 0.0, 0.0}, 4.0, 2.0};
  EXPECT_NEAR(intersection_over_union(box, box), 1.0, 1e-12);
  EXPECT_NEAR(intersection_over_union(box, {{2.0, 0.0, 0.0}, 4.0, 2.0}), 4.0 / 12.0, 1e-12);
  const Box across{{0.0, 0.0, 0.5 * std::numbers::pi}, 4.0, 2.0};
  EXPECT_NEAR(intersection_over_union(box, across), 4.0 / 12.0, 1e-12);
  EXPECT_EQ(intersection_over_union(box, {{9.0, 0.0, 0.0}, 4.0, 2.0}), 0.0);
  EXPECT_EQ(intersection_over_union(box, {{0.0, 0.0, 0.0}, 0.0, 2.0}), 0.0);
}

TEST(IntersectionOverUnion, DoesNotChangeIfTheWorldIsTurned) {
  const Box a{{1.0, 0.5, 0.3}, 4.0, 2.0};
  const Box b{{1.8, 0.1, 0.7}, 3.0, 1.5};
  const geometry::Pose2 turned{-7.0, 3.0, 2.1};
  EXPECT_NEAR(intersection_over_union({turned * a.world_from_box, 4.0, 2.0},
                                      {turned * b.world_from_box, 3.0, 1.5}),
              intersection_over_union(a, b), 1e-12);
  EXPECT_NEAR(intersection_over_union(b, a), intersection_over_union(a, b), 1e-12);
}

struct Judged {
  std::vector<Scene> scenes;
  std::vector<CountedScene> counted;
  MotSequence sequence{2, 2, {}};
};

Judged judged(std::vector<Scene> scenes) {
  Judged result{std::move(scenes), {}};
  for (const Scene& scene : result.scenes) {
    result.counted.push_back(count_scene(scene, kRule));
    result.sequence.frames.push_back(result.counted.back().frame);
  }
  return result;
}

TEST(VehicleBoxErrors, BeginTwoSecondsAfterTheObjectWasSeen) {
  std::vector<Scene> scenes;
  for (int i = 0; i < 5; ++i)
    scenes.push_back(
        {i * kSecondNs, {}, {car_at(10.0, 0.0)}, {track_at(i < 2 ? 12.0 : 11.0, 0.0)}});
  const Judged all = judged(scenes);
  const BoxErrors errors =
      vehicle_box_errors(all.scenes, all.counted, clear_mot(all.sequence, 0.5)).all;
  EXPECT_EQ(errors.rows, 3U);
  EXPECT_NEAR(errors.iou_median, 3.0 / 5.0, 1e-12);
  EXPECT_NEAR(errors.centre_m.p95, 1.0, 1e-12);
  EXPECT_NEAR(errors.velocity_mps.rmse, 0.0, 1e-12);
}

TEST(VehicleBoxErrors, AreGroupedByTheShareOfTheOutlineSeen) {
  std::vector<Scene> scenes;
  for (int i = 0; i < 5; ++i) {
    TrueObject car = car_at(10.0, 0.0);
    car.outline_seen = i < 4 ? 0.19 : 0.6;
    scenes.push_back({i * kSecondNs, {}, {car}, {track_at(i < 4 ? 12.0 : 10.0, 0.0)}});
  }
  const Judged all = judged(scenes);
  const VehicleBoxErrors errors =
      vehicle_box_errors(all.scenes, all.counted, clear_mot(all.sequence, 0.5));
  EXPECT_EQ(errors.by_outline[0].rows, 2U);
  EXPECT_NEAR(errors.by_outline[0].iou_median, 2.0 / 6.0, 1e-12);
  EXPECT_EQ(errors.by_outline[1].rows, 0U);
  EXPECT_EQ(errors.by_outline[3].rows, 1U);
  EXPECT_NEAR(errors.by_outline[3].iou_median, 1.0, 1e-12);
}

TEST(StrictHota, IsOneWhereBoxesOverlapAndNothingWhereTheyHardlyDo) {
  const Judged near = judged({{0, {}, {car_at(10.0, 0.0)}, {track_at(11.0, 0.0)}}});
  const Judged far = judged({{0, {}, {car_at(10.0, 0.0)}, {track_at(13.0, 0.0)}}});
  EXPECT_NEAR(strict_hota(near.scenes, near.counted, 2, 2).hota, 1.0, 1e-9);
  EXPECT_NEAR(strict_hota(far.scenes, far.counted, 2, 2).hota, 0.0, 1e-9);
}

TEST(StrictHota, TakesPeopleByTheirDistance) {
  TrueObject person = car_at(10.0, 0.0);
  person.object_class = "pedestrian";
  const Judged near = judged({{0, {}, {person}, {track_at(10.0, 0.4)}}});
  const Judged far = judged({{0, {}, {person}, {track_at(10.0, 0.6)}}});
  EXPECT_NEAR(strict_hota(near.scenes, near.counted, 2, 2).hota, 1.0, 1e-9);
  EXPECT_NEAR(strict_hota(far.scenes, far.counted, 2, 2).hota, 0.0, 1e-9);
}

TEST(StoppedRows, CountObjectsThatMovedBefore) {
  TrueObject stopped = car_at(10.0, 0.0);
  TrueObject parked = car_at(20.0, 0.0, 1);
  stopped.speed_mps = parked.speed_mps = 0.0;
  const StoppedRows rows = stopped_rows({{0, {}, {car_at(9.0, 0.0), parked}, {}},
                                         {1, {}, {stopped, parked}, {track_at(10.0, 0.0)}},
                                         {2, {}, {stopped, parked}, {}}},
                                        kRule);
  EXPECT_EQ(rows.rows, 2U);
  EXPECT_EQ(rows.covered_rows, 1U);
  EXPECT_EQ(rows.covered_share(), 0.5);
}

}  // namespace
}  // namespace slammot::metrics
