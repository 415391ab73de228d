#include "common/matching/saliency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>

#include <gtest/gtest.h>

#include "common/simulation/scanner_model.hpp"
#include "common/simulation/script.hpp"
#include "tests/support/surfels.hpp"

namespace slammot::matching {
namespace {

using geometry::Vector2;
using slammot::testing::World;

using Views = std::array<std::vector<MatchPoint>, 2>;

/// A building wall with features to the right, a parked car to the left, a bush area farther left
/// and more houses. A bush is stems that let beams pass, and each beam enters the foliage of a stem
/// as deep as it happens to.
simulation::ScriptConfig scene() {
  simulation::ScriptConfig scene;
  scene.fronts.push_back({.along = {{30.0, -8.0}, {-10.0, -8.0}}, .bay_m = 3.0, .depth_m = 1.5});
  scene.fronts.push_back({.along = {{25.0, 20.0}, {28.0, -12.0}}, .bay_m = 5.0, .depth_m = 3.0});
  scene.rows.push_back({.of = simulation::RowOf::parked_car, .from = {9.0, 4.0}, .to = {9.0, 4.0}});
  for (const double y_m : {12.0, 12.7, 13.4, 14.0, 14.7, 15.4})
    scene.rows.push_back({.of = simulation::RowOf::bush,
                          .from = {6.0, y_m},
                          .to = {22.0, y_m},
                          .spacing_m = 0.5,
                          .variation_m = 0.7,
                          .radius_m = 0.03});
  return scene;
}

std::vector<MatchPoint> points_of(const simulation::ScannedWorld& scanned,
                                  const simulation::ScannerConfig& scanner) {
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

/// Two scans from one place.
Views simulated_scans(std::uint64_t seed) {
  const simulation::RayCaster caster(simulation::build_script(scene(), seed));
  const simulation::ScannerConfig scanner;
  simulation::Random random(seed, simulation::Purpose::scanner);
  const simulation::Moment still;
  const simulation::Step step{still, still, 1.0 / scanner.rate_hz};
  Views views;
  for (std::vector<MatchPoint>& points : views)
    points = points_of(simulation::scan_world(scanner, caster, step, random), scanner);
  return views;
}

Views those_where(const Views& views, const std::function<bool(const Vector2&)>& is_of_it) {
  Views some;
  for (std::size_t i = 0; i < views.size(); ++i)
    std::ranges::copy_if(views[i], std::back_inserter(some[i]),
                         [&](const MatchPoint& point) { return is_of_it(point.in_base_m); });
  return some;
}

bool is_in_bush(const Vector2& at_m) {
  return at_m.y() > 11.0 && at_m.y() < 17.0 && at_m.x() < 24.0;
}
bool is_in_wall(const Vector2& at_m) { return at_m.y() < -7.0 && at_m.x() < 25.0; }
bool is_in_car(const Vector2& at_m) {
  return std::abs(at_m.y() - 4.0) < 1.5 && std::abs(at_m.x() - 9.0) < 3.0;
}
bool is_in_scan(const Vector2&) { return true; }

/// Of the mean covariance over several scenes and displacements.
double saliency_of(const std::function<bool(const Vector2&)>& is_of_it, std::size_t again = 1) {
  constexpr int kScenes = 8;
  double trace = 0.0;
  for (int seed = 1; seed <= kScenes; ++seed) {
    const Views views = those_where(simulated_scans(seed), is_of_it);
    EXPECT_GT(views.front().size(), 20U);
    for (int draw = 1; draw <= 2; ++draw) {
      std::mt19937_64 random(draw);
      trace += 0.5 / saliency_score(views[0], views[again], {}, random) / kScenes;
    }
  }
  return 1.0 / trace;
}

double saliency_of(const std::vector<MatchPoint>& points) {
  std::mt19937_64 random(1);
  return saliency_score(points, {}, random);
}

TEST(SaliencyScore, OrdersWhatIsSeenByHowMuchOfAPoseItTells) {
  // Wang 2004, Table 3.2: bush 2.2, building wall 9.0, parked car 15.6, whole scan 15.8.
  const double bush = saliency_of(is_in_bush);
  const double wall = saliency_of(is_in_wall);
  const double car = saliency_of(is_in_car);
  const double scan = saliency_of(is_in_scan);
  RecordProperty("scores", ::testing::PrintToString(std::array{bush, wall, car, scan}));
  EXPECT_LT(1.2 * bush, wall);
  EXPECT_LT(1.2 * wall, car);
  EXPECT_LT(1.2 * car, scan);
}

TEST(SaliencyScore, OfOneViewOfABushIsMoreThanAnotherViewConfirms) {
  EXPECT_LT(1.5 * saliency_of(is_in_bush), saliency_of(is_in_bush, 0));
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
  EXPECT_EQ(saliency_of(std::vector<MatchPoint>{}), 0.0);
}

}  // namespace
}  // namespace slammot::matching
