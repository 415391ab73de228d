#include "common/matching/odometry_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

#include "common/geometry/order_statistics.hpp"

namespace slammot::matching {
namespace {

using Equations = Eigen::Matrix<double, 2, 4>;  // of x, y, way * cos(heading), way * sin(heading)

constexpr int kRounds = 8;
constexpr std::size_t kFewestMotions = 16;
constexpr double kLeastResidual_m = 0.01;  // median: two scans are not registered better
constexpr double kHuber = 1.5;
constexpr double kLeastCondition = 1e-6;

struct PairEquations {
  Equations of_unknowns;
  Eigen::Vector2d right;
};

std::vector<PairEquations> equations_of(std::span<const PairMotion> motions) {
  std::vector<PairEquations> equations;
  for (const PairMotion& motion : motions) {
    const geometry::Pose2& by_scans = motion.by_scans;
    const double cosine = std::cos(by_scans.heading_rad);
    const double sine = std::sin(by_scans.heading_rad);
    PairEquations pair;
    pair.of_unknowns.row(0) << cosine - 1.0, -sine, -by_scans.x_m, by_scans.y_m;
    pair.of_unknowns.row(1) << sine, cosine - 1.0, -by_scans.y_m, -by_scans.x_m;
    pair.right = -motion.by_odometry.translation_m();
    equations.push_back(pair);
  }
  return equations;
}

}  // namespace

std::optional<OdometryPoint> odometry_point(std::span<const PairMotion> motions) {
  if (motions.size() < kFewestMotions) return std::nullopt;
  const std::vector<PairEquations> equations = equations_of(motions);
  std::vector<double> residuals_m(equations.size(), 0.0);
  double scale_m = std::numeric_limits<double>::infinity();
  Eigen::Vector4d solution;
  Eigen::Matrix4d covariance;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < equations.size(); ++i) {
      const double weight = std::min(1.0, kHuber * scale_m / std::max(residuals_m[i], 1e-9));
      const Equations& of_unknowns = equations[i].of_unknowns;
      normal += weight * of_unknowns.transpose() * of_unknowns;
      right += weight * of_unknowns.transpose() * equations[i].right;
    }
    const Eigen::LDLT<Eigen::Matrix4d> solver(normal);
    const Eigen::Vector4d pivots = solver.vectorD();
    if (!(pivots.minCoeff() > kLeastCondition * pivots.maxCoeff())) return std::nullopt;
    solution = solver.solve(right);
    covariance = solver.solve(Eigen::Matrix4d::Identity());
    for (std::size_t i = 0; i < equations.size(); ++i)
      residuals_m[i] = (equations[i].of_unknowns * solution - equations[i].right).norm();
    scale_m = std::max(geometry::upper_median(residuals_m), kLeastResidual_m);
  }
  const double way = solution.tail<2>().norm();
  const Eigen::Vector4d sigma = scale_m * covariance.diagonal().cwiseSqrt();
  return OdometryPoint{{solution(0), solution(1), std::atan2(solution(3), solution(2))},
                       {sigma(0), sigma(1), std::hypot(sigma(2), sigma(3)) / (M_SQRT2 * way)}};
}

}  // namespace slammot::matching
