#include "common/simulation/traffic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "common/simulation/scenario.hpp"
#include "services/simulator/scenario_files.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

/// Separating axes of two boxes, each made smaller by margin_m on every side.
bool overlap(const MovingObject& a, const MovingObject& b, double margin_m) {
  const double reach_m =
      0.5 * (a.size.length_m + a.size.width_m + b.size.length_m + b.size.width_m);
  const Vector2 apart = a.world_from_object.translation_m() - b.world_from_object.translation_m();
  if (apart.squaredNorm() > reach_m * reach_m) return false;
  const auto corners = [margin_m](const MovingObject& object) {
    const double x = 0.5 * object.size.length_m - margin_m;
    const double y = 0.5 * object.size.width_m - margin_m;
    const Pose2& pose = object.world_from_object;
    return std::array<Vector2, 4>{pose * Vector2{x, y}, pose * Vector2{-x, y},
                                  pose * Vector2{-x, -y}, pose * Vector2{x, -y}};
  };
  const auto corners_a = corners(a);
  const auto corners_b = corners(b);
  for (const double heading_rad :
       {a.world_from_object.heading_rad, a.world_from_object.heading_rad + M_PI_2,
        b.world_from_object.heading_rad, b.world_from_object.heading_rad + M_PI_2}) {
    const Vector2 axis{std::cos(heading_rad), std::sin(heading_rad)};
    const auto reach = [&axis](const std::array<Vector2, 4>& points) {
      double low = 1e9;
      double high = -1e9;
      for (const Vector2& point : points)
        low = std::min(low, point.dot(axis)), high = std::max(high, point.dot(axis));
      return std::pair{low, high};
    };
    const auto [low_a, high_a] = reach(corners_a);
    const auto [low_b, high_b] = reach(corners_b);
    if (high_a <= low_b || high_b <= low_a) return false;
  }
  return true;
}

constexpr double kStep_s = 0.1;
constexpr int kSteps = 1500;

/// Traffic and people of a shipped scenario, without a scanner.
struct Streets {
  explicit Streets(const ScenarioConfig& scenario)
      : plan(scenario.city, scenario.seed),
        traffic(plan, {scenario.traffic, scenario.route, scenario.seed}),
        walkers(pavements(plan), scenario.walkers, scenario.seed) {}

  void advance(double dt_s) {
    traffic.advance(dt_s, walkers.on_road());
    walkers.advance(dt_s, traffic.street_view());
  }

  StreetPlan plan;
  Traffic traffic;
  Walkers walkers;
};

class TrafficOfScenario : public ::testing::TestWithParam<const char*> {
 protected:
  ScenarioConfig scenario_ = *simulator::load_scenario(GetParam());
  Streets streets_{scenario_};
};

TEST_P(TrafficOfScenario, NeverDrivesOneBodyIntoAnother) {
  std::set<std::pair<int, int>> touching;
  for (int i = 0; i < kSteps; ++i) {
    streets_.advance(kStep_s);
    const auto& objects = streets_.traffic.objects();
    for (std::size_t a = 0; a < objects.size(); ++a) {
      for (std::size_t b = a + 1; b < objects.size(); ++b) {
        // A long bus may brush a corner in a tight turn, but never the vehicle that carries the
        // scanners.
        const bool bus = objects[a].kind == ObjectClass::bus || objects[b].kind == ObjectClass::bus;
        if (bus && a != 0) continue;
        if (overlap(objects[a], objects[b], 0.05)) touching.insert({objects[a].id, objects[b].id});
      }
    }
  }
  EXPECT_EQ(touching.size(), 0U);
  for (const auto& [a, b] : touching) {
    ADD_FAILURE() << name(streets_.traffic.objects()[a].kind) << ' ' << a << " and "
                  << name(streets_.traffic.objects()[b].kind) << ' ' << b;
  }
}

TEST_P(TrafficOfScenario, NeverDrivesOverPeople) {
  int steps_over_someone = 0;
  for (int i = 0; i < kSteps; ++i) {
    streets_.advance(kStep_s);
    for (const MovingObject& person : streets_.walkers.objects(1000)) {
      for (const MovingObject& object : streets_.traffic.objects()) {
        // People squeeze past the bumpers of cars that creep.
        steps_over_someone += object.speed_mps > 2.0 && overlap(object, person, 0.1) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(steps_over_someone, 0);
}

TEST_P(TrafficOfScenario, KeepsFlowing) {
  double travelled_m = 0.0;
  for (int i = 0; i < 3000; ++i) {
    streets_.advance(kStep_s);
    if (i < 2000) continue;  // what stands still after 200 s stands still for ever
    for (const MovingObject& object : streets_.traffic.objects())
      travelled_m += object.speed_mps * kStep_s;
  }
  const auto drivers = static_cast<double>(streets_.traffic.objects().size());
  EXPECT_GT(travelled_m / drivers, 150.0);  // in 100 s
}

INSTANTIATE_TEST_SUITE_P(Shipped, TrafficOfScenario, ::testing::Values("block", "city", "quiet"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Traffic, HasVehiclesOfAllSizesIfTheScenarioSaysSo) {
  const auto lengths_m = [](bool varied) {
    ScenarioConfig scenario = *simulator::load_scenario("city");
    scenario.traffic.varied_sizes = varied;
    const StreetPlan plan(scenario.city, scenario.seed);
    const Traffic traffic(plan, {scenario.traffic, scenario.route, scenario.seed});
    std::map<ObjectClass, std::vector<double>> lengths;
    for (const MovingObject& object : traffic.objects())
      if (object.id > 0) lengths[object.kind].push_back(object.size.length_m);
    for (auto& [kind, of_kind] : lengths) std::ranges::sort(of_kind);
    return lengths;
  };
  auto alike = lengths_m(false);
  auto varied = lengths_m(true);
  EXPECT_EQ(alike[ObjectClass::bus].front(), alike[ObjectClass::bus].back());
  EXPECT_GT(varied[ObjectClass::bus].back() - varied[ObjectClass::bus].front(), 3.0);
  EXPECT_GT(varied[ObjectClass::truck].back() - varied[ObjectClass::truck].front(), 3.0);
  EXPECT_LT(varied[ObjectClass::car].front(), 3.8);
  EXPECT_GT(varied[ObjectClass::car].back(), 5.0);
}

}  // namespace
}  // namespace slammot::simulation
