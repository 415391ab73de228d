#include "services/localization/relocalization.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::MappedWorld;
using slammot::testing::PoseNear;

/// A search from the origin, by a scan made at the truth.
RelocalizationResult find(const MappedWorld& world, const ScanPoints& points, int lost_scans = 4) {
  Step step;
  step.source = StepSource::kVelocityAlone;
  step.after.covariance.setIdentity();
  step.after.covariance *= 1e-4;
  ScanMatcher matcher(world.config());
  return Relocalization(world.config()).find(lost_scans, step, points, world.map(), matcher);
}

TEST(Relocalization, FindsTheVehicleFarFromThePredictionAndTurnedAround) {
  const MappedWorld room(slammot::testing::room());
  const Pose2 truth{1.5, -0.8, 2.5};
  const RelocalizationResult result = find(room, room.points_at(truth));
  EXPECT_TRUE(result.has_searched);
  ASSERT_TRUE(result.found);
  EXPECT_TRUE(result.found->is_believed);
  EXPECT_THAT(result.found->odom_from_base.pose, PoseNear(truth, 0.05));
}

TEST(Relocalization, FindsNothingByAScanOfAnotherPlace) {
  const MappedWorld room(slammot::testing::room());
  const MappedWorld elsewhere(slammot::testing::box({0.0, 0.0, 0.3}, 30.0, 26.0));
  EXPECT_FALSE(find(room, elsewhere.points_at({})).found);
}

TEST(Relocalization, FindsNothingWhereTooMuchOfTheScanIsInFreeSpace) {
  const MappedWorld room(slammot::testing::room());
  const Pose2 truth{0.5, -0.8, 0.4};
  const auto found_beside_a_screen = [&](double half_angle_rad) {
    const double half_m = 2.0 * std::tan(half_angle_rad);  // 2 m to its right
    const geometry::Vector2 middle_m = truth.translation_m() - geometry::Vector2(0.0, 2.0);
    const slammot::testing::World screen{
        {middle_m - geometry::Vector2(half_m, 0.0), middle_m + geometry::Vector2(half_m, 0.0)}};
    const MappedWorld changed(slammot::testing::joined(slammot::testing::room(), screen));
    return find(room, changed.points_at(truth)).found.has_value();
  };
  EXPECT_TRUE(found_beside_a_screen(0.5)) << "a sixth of the beams";
  EXPECT_FALSE(found_beside_a_screen(0.88)) << "28 % of them, less than what it is lost by";
}

TEST(Relocalization, WaitsWhereTwoPlacesAreAboutAsGood) {
  const MappedWorld symmetric(slammot::testing::box({0.0, 0.0, 0.0}, 12.0, 8.0));
  const RelocalizationResult result =
      find(symmetric, symmetric.points_at({0.03, 0.02, 0.2}));  // or turned by half a circle
  EXPECT_TRUE(result.has_searched);
  EXPECT_FALSE(result.found);
}

TEST(Relocalization, SearchesLessOftenTheLongerTheVehicleIsLost) {
  const MappedWorld room(slammot::testing::room());
  const ScanPoints points = room.points_at({});
  int searches = 0;
  for (int lost_scans = 1; lost_scans <= 20; ++lost_scans)
    searches += find(room, points, lost_scans).has_searched;
  EXPECT_EQ(searches, 5) << "after 1, 2, 4, 8 and 16 scans";
}

}  // namespace
}  // namespace slammot::localization
