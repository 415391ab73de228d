#include "common/matching/fit_profile.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/surfels.hpp"
#include "tests/support/synthetic_world.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::points_seen;
using slammot::testing::surfels_of;

const slammot::testing::World kRoom = slammot::testing::room();

std::vector<MatchPoint> noisy_scan() {
  std::mt19937 random(7);
  return points_seen(kRoom, {0.3, -0.2, 0.4}, 180, 0.05, random);
}

/// The oracle: a registration that is held at the pose.
double fit_of_registration(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                           const Pose2& pose, PointToLineConfig config) {
  config.coarse_steps = 0;
  config.fine_steps = 1;
  const geometry::UncertainPose2 exactly{pose, 1e-6 * geometry::Matrix3::Identity()};
  return fit_of(PointToLineMatcher().match(points, surfels, exactly, pose, config),
                config.robust_scale_m);
}

class FitsAt : public ::testing::TestWithParam<double> {};

TEST_P(FitsAt, AreThoseOfRegistrationsHeldThere) {
  const double cell_m = GetParam();
  const grids::SurfelMap surfels = surfels_of(kRoom, Vector2::Zero(), cell_m);
  const std::vector<MatchPoint> points = noisy_scan();
  PointToLineConfig config;
  config.body_sigma_m = 0.15;
  std::vector<Vector2> positions_m;
  for (int i = -12; i <= 12; ++i) positions_m.emplace_back(0.3 + 0.11 * i, -0.2 + 0.02 * i);
  FitProfile profile;
  const std::span<const double> fits = profile.fits_at(points, surfels, 0.4, positions_m, config);
  ASSERT_EQ(fits.size(), positions_m.size());
  for (std::size_t i = 0; i < fits.size(); ++i)
    EXPECT_EQ(fits[i], fit_of_registration(points, surfels,
                                           {positions_m[i].x(), positions_m[i].y(), 0.4}, config));
  EXPECT_GT(fits[12], 0.3);
}

INSTANTIATE_TEST_SUITE_P(CellsOf, FitsAt, ::testing::Values(0.1, 0.2, 0.5));

TEST(FitsAtNoPoints, AreZero) {
  const std::vector<Vector2> positions_m{Vector2::Zero()};
  FitProfile profile;
  const std::span<const double> fits = profile.fits_at({}, surfels_of(kRoom), 0.0, positions_m, {});
  ASSERT_EQ(fits.size(), 1U);
  EXPECT_EQ(fits.front(), 0.0);
}

}  // namespace
}  // namespace slammot::matching
