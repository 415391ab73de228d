#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/ring_drive.hpp"

namespace slammot::loop_closing {
namespace {

using flow::ClosureState;
using flow::Constraint;
using flow::ConstraintKind;
using flow::Submap;
using geometry::Pose2;
using slammot::testing::drive;
using slammot::testing::FloorPlan;
using slammot::testing::indoor_loop_closing;

/// Doors and niches along a stretch of corridor; each metre is generated from the seed alone.
struct Block {
  unsigned seed = 0;
  double length_m = 0.0;
};

void add_block(FloorPlan& plan, double from_x_m, const Block& block) {
  std::mt19937 random(block.seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const double side : {-1.0, 1.0}) {
    double x_m = from_x_m;
    while (x_m < from_x_m + block.length_m) {
      const double wall_m = std::min(0.8 + 2.5 * share(random), from_x_m + block.length_m - x_m);
      const double niche_m =
          std::min(0.6 + 1.2 * share(random), from_x_m + block.length_m - x_m - wall_m);
      const double depth_m = 0.3 + 1.5 * share(random);
      plan.add({x_m, side}, {x_m + wall_m, side});
      x_m += wall_m;
      if (niche_m <= 0.0) break;
      plan.add({x_m, side}, {x_m, side * (1.0 + depth_m)});
      plan.add({x_m, side * (1.0 + depth_m)}, {x_m + niche_m, side * (1.0 + depth_m)});
      plan.add({x_m + niche_m, side * (1.0 + depth_m)}, {x_m + niche_m, side});
      x_m += niche_m;
    }
  }
}

/// A corridor that contains one block twice, with different blocks before, between and after.
struct LookAlikePair {
  explicit LookAlikePair(unsigned seed) {
    std::mt19937 random(1000 + seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const double alike_m = 8.0 + 14.0 * share(random);
    const double between_m = 20.0 + 20.0 * share(random);
    const std::vector<Block> blocks{{4 * seed, 15.0},
                                    {4 * seed + 1, alike_m},
                                    {4 * seed + 2, between_m},
                                    {4 * seed + 1, alike_m},
                                    {4 * seed + 3, 20.0}};
    double x_m = -10.0;
    for (const Block& block : blocks) {
      add_block(plan, x_m, block);
      x_m += block.length_m;
    }
    for (double at_m = -4.0; at_m < x_m - 6.0; at_m += 0.5) way.push_back({at_m, 0.0, 0.0});
  }
  FloorPlan plan;
  std::vector<Pose2> way;
};

int false_closures_that_last(unsigned seed, double sigma_scale) {
  const LookAlikePair pair(seed);
  LoopClosingConfig config = indoor_loop_closing();
  config.max_distance_m = 12.0;
  LoopCloser closer(config);
  for (const Submap& submap : drive(pair.plan, pair.way, 0.0, sigma_scale)) closer.add(submap);
  closer.finish();
  int lasting = 0;
  for (const Constraint& constraint : closer.constraints()) {
    if (constraint.kind != ConstraintKind::kLoop ||
        constraint.verdict.state != ClosureState::kAccepted)
      continue;
    const Pose2 truth =
        inverse(pair.way[12 * constraint.from.value]) * pair.way[12 * constraint.to.value];
    if ((truth.translation_m() - constraint.from_to.pose.translation_m()).norm() > 1.0) ++lasting;
  }
  return lasting;
}

/// Number of pairs, from SLAMMOT_LOOK_ALIKE_PAIRS; tests/look_alike.sh runs all 200.
unsigned pairs_to_try() {
  const char* const pairs = std::getenv("SLAMMOT_LOOK_ALIKE_PAIRS");
  return pairs == nullptr ? 6U : static_cast<unsigned>(std::strtoul(pairs, nullptr, 10));
}

TEST(LookAlikePlaces, AreNotConfusedAtTheEndOfTheDrive) {
  for (unsigned seed = 0; seed < pairs_to_try(); ++seed) {
    // From odometry that excludes the other place to odometry that admits either.
    const double sigma_scale = seed % 3 == 0 ? 1.0 : seed % 3 == 1 ? 4.0 : 10.0;
    EXPECT_EQ(false_closures_that_last(seed, sigma_scale), 0) << "pair " << seed;
  }
}

}  // namespace
}  // namespace slammot::loop_closing
