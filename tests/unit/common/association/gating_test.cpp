#include "common/association/gating.hpp"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

namespace slammot::association {
namespace {

TEST(PlanarGate, LetsThroughTheShareOfTruePairsThatItPromises) {
  const Eigen::Matrix2d covariance{{0.5, 0.3}, {0.3, 1.2}};
  const Eigen::Matrix2d root = covariance.llt().matrixL();
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 20000;
  int inside = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector2d residual = root * Eigen::Vector2d(normal(random), normal(random));
    inside += mahalanobis_squared<2>(residual, covariance) <= planar_gate(0.99) ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inside) / kDraws, 0.99, 0.003);
}

TEST(MahalanobisSquared, PrefersTheFartherPointAlongTheUncertainDirection) {
  const Eigen::Matrix2d covariance{{4.0, 0.0}, {0.0, 0.01}};  // Wang 2004, Figure 5.1
  EXPECT_LT(mahalanobis_squared<2>({2.0, 0.0}, covariance),
            mahalanobis_squared<2>({0.0, 0.5}, covariance));
}

}  // namespace
}  // namespace slammot::association
