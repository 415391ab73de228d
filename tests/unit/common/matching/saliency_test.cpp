#include "common/matching/saliency.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "common/simulation/scanner_model.hpp"
#include "common/simulation/script.hpp"
#include "tests/support/surfels.hpp"

namespace slammot::matching {
namespace {

using geometry::Vector2;
using slammot::testing::World;

/// What the simulated scanner sees of a wall to the right, a parked car to the left, bushes farther
/// left and more houses.
std::vector<MatchPoint> simulated_scan() {
  simulation::ScriptConfig scene;
  scene.fronts.push_back({.along = {{30.0, -8.0}, {-10.0, -8.0}}, .depth_m = 0.0});
  scene.fronts.push_back({.along = {{35.0, 20.0}, {45.0, -25.0}}, .bay_m = 5.0, .depth_m = 3.0});
  scene.rows.push_back({.of = simulation::RowOf::parked_car, .from = {9.0, 4.0}, .to = {9.0, 4.0}});
  scene.rows.push_back({.of = simulation::RowOf::bush,
                        .from = {6.0, 14.0},
                        .to = {22.0, 14.0},
                        .spacing_m = 1.2,
                        .variation_m = 0.5,
                        .radius_m = 0.8});
  const simulation::RayCaster caster(simulation::build_script(scene, 3));
  const simulation::ScannerConfig scanner;
  simulation::Random random(1, simulation::Purpose::scanner);
  const simulation::Moment still;
  const simulation::ScannedWorld scanned =
      simulation::scan_world(scanner, caster, {still, still, 1.0 / scanner.rate_hz}, random);
  std::vector<MatchPoint> points;
  for (std::size_t beam = 0; beam < scanned.range_m.size(); ++beam) {
    const double range_m = static_cast<double>(scanned.range_m[beam]);
    if (range_m >= 80.0) continue;
    const double angle_rad = scanner.first_beam_rad + scanner.field_of_view_rad *
                                                          static_cast<double>(beam) /
                                                          (scanner.beams - 1);
    points.push_back(
        {{scanner.ahead_m + range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)},
         0.03 + 0.001 * range_m});
  }
  return points;
}

std::vector<MatchPoint> those_where(const std::vector<MatchPoint>& points,
                                    const std::function<bool(const Vector2&)>& is_of_it) {
  std::vector<MatchPoint> some;
  for (const MatchPoint& point : points) {
    if (is_of_it(point.in_base_m)) some.push_back(point);
  }
  return some;
}

double saliency_of(const std::vector<MatchPoint>& points) {
  std::mt19937_64 random(1);
  return saliency_score(points, {}, random);
}

TEST(SaliencyScore, OrdersWhatIsSeenByHowMuchOfAPoseItTells) {
  // Wang 2004, Table 3.2: bush 2.2, building wall 9.0, parked car 15.6, whole scan 15.8. Bushes of
  // the simulator are a row of circles with clean outlines, which tell more than a wall that is
  // straight throughout; the rest is in the thesis' order.
  const auto whole = simulated_scan();
  const auto wall =
      those_where(whole, [](const Vector2& at_m) { return at_m.y() < -7.0 && at_m.x() < 25.0; });
  const auto car = those_where(whole, [](const Vector2& at_m) {
    return std::abs(at_m.y() - 4.0) < 1.5 && std::abs(at_m.x() - 9.0) < 3.0;
  });
  const auto bushes = those_where(whole, [](const Vector2& at_m) {
    return at_m.y() > 11.0 && at_m.y() < 17.0 && at_m.x() < 26.0;
  });
  for (const auto* object : {&wall, &car, &bushes}) ASSERT_GT(object->size(), 20U);
  EXPECT_LT(saliency_of(wall), saliency_of(bushes));
  EXPECT_LT(saliency_of(bushes), saliency_of(car));
  EXPECT_LT(saliency_of(car), saliency_of(whole));
}

TEST(SaliencyScore, DoesNotDependOnWhereTheFrameIs) {
  const World corner = {{{-4.0, 3.0}, {5.0, 3.0}}, {{5.0, 3.0}, {5.0, -4.0}}};
  std::mt19937 noise(1);
  auto points = slammot::testing::points_seen(corner, {}, 360, 0.02, noise);
  const double here = saliency_of(points);
  for (MatchPoint& point : points) point.in_base_m += Vector2(103.0, -51.0);
  EXPECT_NEAR(saliency_of(points), here, 0.02 * here);
}

TEST(SaliencyScore, IsThatOfTheDisplacementsForWhatTellsNothing) {
  const SaliencyConfig config;
  const double of_nothing = 1.0 / (2.0 * config.position_sigma_m * config.position_sigma_m +
                                   config.heading_sigma_rad * config.heading_sigma_rad);
  std::vector<MatchPoint> unsure;  // as good as no measurement
  for (int i = 0; i < 20; ++i) unsure.push_back({{0.3 * i, 0.0}, 5.0});
  EXPECT_NEAR(saliency_of(unsure), of_nothing, 0.1 * of_nothing);
  EXPECT_EQ(saliency_of({}), 0.0);
}

}  // namespace
}  // namespace slammot::matching
