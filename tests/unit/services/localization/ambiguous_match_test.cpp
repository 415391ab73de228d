#include "services/localization/ambiguous_match.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/surfels.hpp"

namespace slammot::localization {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using slammot::testing::points_seen;
using slammot::testing::World;

const World kWall = {{{-28.0, 3.0}, {28.0, 3.0}}};
const World kSkewWall = slammot::testing::moved({{{-24.0, 3.0}, {24.0, 3.0}}}, {0.0, 0.0, 0.5});
const World kCorner = {{{-8.0, 3.0}, {5.0, 3.0}}, {{5.0, 3.0}, {5.0, -8.0}}};

/// A map whose walls have the noise of what they were made from, as maps have; the closed form on
/// it.
struct Place {
  grids::SurfelMap surfels;
  std::vector<matching::MatchPoint> points;
  UncertainPose2 prior;
  matching::PointToLineResult closed_form;
};

Place place_in(const World& world, const Pose2& truth, const UncertainPose2& prior) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.02);
  Place place{.surfels = grids::SurfelMap(grids::window_around({0.0, 0.0}, 60.0, 0.5), 1000.0),
              .points = {},
              .prior = prior,
              .closed_form = {}};
  for (const auto& wall : world) {
    const geometry::Vector2 along_m = wall.to_m - wall.from_m;
    const int points = static_cast<int>(along_m.norm() / 0.1);
    for (int i = 0; i <= points; ++i)
      place.surfels.add(wall.from_m + along_m * i / points +
                        geometry::Vector2(noise(random), noise(random)));
  }
  place.points = points_seen(world, truth, 360, 0.02, random, 20.0);
  place.closed_form =
      matching::PointToLineMatcher().match(place.points, place.surfels, prior, prior.pose, {});
  return place;
}

UncertainPose2 prior_at(const Pose2& pose) {
  return {pose, Eigen::Vector3d(0.04, 0.01, 0.0004).asDiagonal()};
}

UncertainPose2 sampled(const Place& place, std::uint64_t seed = 1,
                       const AmbiguousMatchConfig& config = {}) {
  return AmbiguousMatcher().match({place.points, place.surfels, place.prior, place.closed_form},
                                  config, {}, seed);
}

TEST(SaysLittle, OfAWallAndNotOfACorner) {
  EXPECT_TRUE(says_little(place_in(kWall, {}, prior_at({})).closed_form.scan_information, {}));
  EXPECT_TRUE(says_little(place_in(kSkewWall, {}, prior_at({})).closed_form.scan_information, {}));
  EXPECT_FALSE(says_little(place_in(kCorner, {}, prior_at({})).closed_form.scan_information, {}));
  EXPECT_TRUE(says_little(Matrix3::Zero(), {}));
  EXPECT_FALSE(says_little(Matrix3::Zero(), {.weak_share = 0.0}));
}

TEST(AmbiguousMatch, LeavesThePredictionAloneAlongAWallAndCorrectsItAcross) {
  const Place place = place_in(kWall, {}, prior_at({0.3, 0.08, 0.01}));
  const UncertainPose2 found = sampled(place);
  EXPECT_NEAR(found.pose.x_m, 0.3, 0.01);
  EXPECT_NEAR(found.covariance(0, 0), place.prior.covariance(0, 0),
              1e-3 * place.prior.covariance(0, 0));
  EXPECT_NEAR(found.pose.y_m, 0.0, 0.02);
  EXPECT_LT(found.covariance(1, 1), 0.1 * place.prior.covariance(1, 1));
  EXPECT_NEAR(found.pose.heading_rad, 0.0, 0.005);
  // For which the closed form took the noise of the wall.
  EXPECT_LT(place.closed_form.map_from_base.covariance(0, 0), 0.999 * place.prior.covariance(0, 0));
}

TEST(AmbiguousMatch, DoesNotBecomeSureAlongAWallThatIsSeenAgainAndAgain) {
  UncertainPose2 by_samples = prior_at({});
  UncertainPose2 by_closed_form = by_samples;
  for (std::uint64_t scan = 0; scan < 200; ++scan) {
    by_closed_form = place_in(kWall, {}, by_closed_form).closed_form.map_from_base;
    by_samples = sampled(place_in(kWall, {}, by_samples), scan);
    by_samples.covariance.bottomRightCorner<2, 2>().diagonal() +=
        Eigen::Vector2d(1e-4, 1e-6);  // as every step adds
    by_closed_form.covariance.bottomRightCorner<2, 2>().diagonal() += Eigen::Vector2d(1e-4, 1e-6);
  }
  EXPECT_LT(by_closed_form.covariance(0, 0), 0.015);
  EXPECT_GT(by_samples.covariance(0, 0), 0.035);
}

TEST(AmbiguousMatch, IsNeverSurerThanTheClosedForm) {
  for (const World& world : {kWall, kSkewWall}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Place place = place_in(world, {}, prior_at({0.1, 0.05, 0.01}));
      const Matrix3 more =
          sampled(place, seed).covariance - place.closed_form.map_from_base.covariance;
      EXPECT_GT(more(0, 0), -0.01 * place.closed_form.map_from_base.covariance(0, 0));
      EXPECT_GT(more(1, 1), -0.01 * place.closed_form.map_from_base.covariance(1, 1));
    }
  }
}

TEST(AmbiguousMatch, GivesTheSameForTheSameSeed) {
  const Place place = place_in(kWall, {}, prior_at({0.3, 0.08, 0.01}));
  EXPECT_EQ(sampled(place, 7).pose, sampled(place, 7).pose);
  EXPECT_EQ(sampled(place, 7).covariance, sampled(place, 7).covariance);
}

TEST(AmbiguousMatch, IsThePredictionWhereNothingIsSeen) {
  Place place = place_in(kWall, {}, prior_at({0.3, 0.08, 0.01}));
  place.surfels = grids::SurfelMap(grids::window_around({0.0, 0.0}, 60.0, 0.5), 1000.0);
  place.closed_form = matching::PointToLineMatcher().match(place.points, place.surfels, place.prior,
                                                           place.prior.pose, {});
  const UncertainPose2 found = sampled(place);
  EXPECT_NEAR(found.pose.x_m, place.prior.pose.x_m, 1e-12);
  EXPECT_TRUE(found.covariance.isApprox(place.prior.covariance, 1e-9));
}

}  // namespace
}  // namespace slammot::localization
