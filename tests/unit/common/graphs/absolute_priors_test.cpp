#include "common/graphs/absolute_priors.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "common/simulation/random.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix2;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::Vector2;

constexpr double kSigma_m = 1.5;
constexpr double kSigma_rad = 0.03;
constexpr double kBias_rad = 0.1;
const Pose2 kEnuFromMap{120.0, -40.0, 0.7};

/// A drive around a block of 200 m with a submap every 50 m, five fixes and readings in each.
struct PriorsOfADrive : ::testing::Test {
  PriorsOfADrive() {
    for (std::uint32_t i = 0; i < 16; ++i) {
      const Pose2 pose{
          i < 4 ? 50.0 * i : (i < 8 ? 200.0 : (i < 12 ? 200.0 - 50.0 * (i - 8) : 0.0)),
          i < 4 ? 0.0 : (i < 8 ? 50.0 * (i - 4) : (i < 12 ? 200.0 : 200.0 - 50.0 * (i - 12))),
          geometry::wrap_angle(1.5707963 * (i / 4))};
      nodes.push_back({{i}, pose});
    }
    for (const flow::CorrectedSubmap& node : nodes) measure(node);
    for (std::size_t i = 1; i < nodes.size(); ++i)
      constraints.push_back(
          {nodes[i - 1].submap_id,
           nodes[i].submap_id,
           flow::ConstraintKind::kOdometric,
           {geometry::inverse(nodes[i - 1].map_from_submap) * nodes[i].map_from_submap,
            Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal()}});
  }

  void measure(const flow::CorrectedSubmap& node) {
    for (int i = 0; i < 5; ++i) {
      const Vector2 in_node_m{10.0 * i, 0.0};
      const Vector2 error_m{kSigma_m * random.normal(), kSigma_m * random.normal()};
      priors.positions.push_back({node.submap_id, in_node_m,
                                  kEnuFromMap * (node.map_from_submap * in_node_m) + error_m,
                                  kSigma_m * kSigma_m * Matrix2::Identity()});
      priors.headings.push_back(
          {node.submap_id, 0.0,
           geometry::wrap_angle(kEnuFromMap.heading_rad + node.map_from_submap.heading_rad +
                                kBias_rad + kSigma_rad * random.normal()),
           kSigma_rad});
    }
  }

  simulation::Random random{1, simulation::Purpose::gnss};
  std::vector<flow::CorrectedSubmap> nodes;
  std::vector<flow::Constraint> constraints;
  AbsolutePriors priors;
};

TEST_F(PriorsOfADrive, GivePlaceAndDirectionOfTheMapAndBiasOfTheCompass) {
  const AbsoluteFit fit = align(nodes, priors);
  ASSERT_TRUE(fit.has_position);
  EXPECT_NEAR(fit.enu_from_map.x_m, kEnuFromMap.x_m, 1.0);
  EXPECT_NEAR(fit.enu_from_map.y_m, kEnuFromMap.y_m, 1.0);
  EXPECT_NEAR(fit.enu_from_map.heading_rad, kEnuFromMap.heading_rad, 0.005);
  EXPECT_NEAR(fit.heading_bias_rad, kBias_rad, 0.02);
  EXPECT_GE(fit.positions.inliers(), 75U);
}

TEST_F(PriorsOfADrive, AreOutliersWhereMultipathLasts) {
  for (std::size_t i = 20; i < 45; ++i) priors.positions[i].in_enu_m += Vector2(40.0, -15.0);
  const AbsoluteFit fit = align(nodes, priors);
  ASSERT_TRUE(fit.has_position);
  for (std::size_t i = 20; i < 45; ++i) EXPECT_FALSE(fit.positions.is_inlier[i]);
  EXPECT_NEAR(fit.enu_from_map.x_m, kEnuFromMap.x_m, 1.5);
  EXPECT_NEAR(fit.enu_from_map.heading_rad, kEnuFromMap.heading_rad, 0.01);
}

TEST_F(PriorsOfADrive, AreOutliersWhereIronIsNear) {
  for (std::size_t i = 20; i < 45; ++i) priors.headings[i].in_enu_rad += 0.8;
  const AbsoluteFit fit = align(nodes, priors);
  for (std::size_t i = 20; i < 45; ++i) EXPECT_FALSE(fit.headings.is_inlier[i]);
  EXPECT_NEAR(fit.heading_bias_rad, kBias_rad, 0.02);
}

TEST_F(PriorsOfADrive, WithoutFixesGiveTheDirectionWithTheCompassesBias) {
  priors.positions.clear();
  const AbsoluteFit fit = align(nodes, priors);
  EXPECT_FALSE(fit.has_position);
  ASSERT_TRUE(fit.has_direction);
  EXPECT_NEAR(fit.enu_from_map.heading_rad, kEnuFromMap.heading_rad + kBias_rad, 0.02);
  EXPECT_GE(fit.direction_sigma_rad, 0.05);
}

TEST_F(PriorsOfADrive, AreTooFewBelowTen) {
  priors.positions.resize(9);
  priors.headings.resize(9);
  const AbsoluteFit fit = align(nodes, priors);
  EXPECT_FALSE(fit.has_position);
  EXPECT_FALSE(fit.has_direction);
}

TEST_F(PriorsOfADrive, SaveLittleByBendingAGraphThatIsRight) {
  const auto bent = bend(nodes, constraints, priors, align(nodes, priors));
  ASSERT_TRUE(bent);
  EXPECT_LT(bent->cost_saved, 25.0);
}

TEST_F(PriorsOfADrive, BendAGraphWithAWrongTurnBack) {
  const std::vector<flow::CorrectedSubmap> truth = nodes;
  const Pose2 wrong_turn{0.0, 0.0, 0.3};
  constraints[7].from_to.pose = constraints[7].from_to.pose * wrong_turn;
  constraints[7].from_to.covariance = Eigen::Vector3d(1.0, 1.0, 1.0).asDiagonal();
  for (std::size_t i = 1; i < nodes.size(); ++i)
    nodes[i].map_from_submap = nodes[i - 1].map_from_submap * constraints[i - 1].from_to.pose;
  auto bent = bend(nodes, constraints, priors, align(nodes, priors));
  for (int time = 0; bent && time < 2; ++time)
    bent = bend(bent->nodes, constraints, priors, align(bent->nodes, priors));
  ASSERT_TRUE(bent);
  const Vector2 before_m =
      nodes.back().map_from_submap.translation_m() - truth.back().map_from_submap.translation_m();
  const Vector2 after_m = bent->nodes.back().map_from_submap.translation_m() -
                          truth.back().map_from_submap.translation_m();
  EXPECT_GT(before_m.norm(), 30.0);
  EXPECT_LT(after_m.norm(), 3.0);
}

}  // namespace
}  // namespace slammot::graphs
