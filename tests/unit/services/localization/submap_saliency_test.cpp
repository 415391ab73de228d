#include "services/localization/submap_saliency.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

/// Surfels each quarter metre.
void add_wall(flow::Submap& submap, const geometry::Vector2& from_m,
              const geometry::Vector2& to_m) {
  const auto steps = static_cast<int>((to_m - from_m).norm() / 0.25);
  for (int i = 0; i < steps; ++i) {
    const geometry::Vector2 at_m = from_m + (to_m - from_m) * i / steps;
    flow::Surfel surfel;
    surfel.x_m = static_cast<float>(at_m.x());
    surfel.y_m = static_cast<float>(at_m.y());
    submap.surfels.push_back(surfel);
  }
}

flow::Submap straight_corridor() {
  flow::Submap submap;
  add_wall(submap, {-20.0, 2.0}, {20.0, 2.0});
  add_wall(submap, {-20.0, -2.0}, {20.0, -2.0});
  return submap;
}

TEST(SubmapSaliency, IsLargerForAJunctionThanForAStraightCorridor) {
  flow::Submap junction = straight_corridor();
  add_wall(junction, {-2.0, 2.0}, {-2.0, 20.0});
  add_wall(junction, {2.0, 2.0}, {2.0, 20.0});
  const double of_corridor = saliency_of(straight_corridor());
  EXPECT_GT(of_corridor, 2.0) << "as of a shape that tells nothing";
  EXPECT_GT(saliency_of(junction), 2.0 * of_corridor);
}

TEST(SubmapSaliency, IsTheSameForTheSameSubmapAndZeroForAnEmptyOne) {
  EXPECT_EQ(saliency_of(straight_corridor()), saliency_of(straight_corridor()));
  EXPECT_EQ(saliency_of({}), 0.0);
}

}  // namespace
}  // namespace slammot::localization
