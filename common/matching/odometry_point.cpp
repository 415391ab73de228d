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

double huber_weight(double scale_m, double residual_m) {
  return std::min(1.0, kHuber * scale_m / std::max(residual_m, 1e-9));
}

/// Of the unknowns: the larger of what the median residual says, and of what the residuals
/// themselves say (White 1980), as pairs that turn much may be registered worse.
Eigen::Vector4d standard_errors(const std::vector<PairEquations>& equations,
                                const std::vector<double>& residuals_m, double scale_m,
                                const Eigen::Vector4d& solution,
                                const Eigen::Matrix4d& covariance) {
  Eigen::Matrix4d scatter = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const Eigen::Vector2d residual_m = equations[i].of_unknowns * solution - equations[i].right;
    const Eigen::Vector4d score =
        huber_weight(scale_m, residuals_m[i]) * equations[i].of_unknowns.transpose() * residual_m;
    scatter += score * score.transpose();
  }
  const Eigen::Vector4d variances = (covariance * scatter * covariance).diagonal();
  return variances.cwiseMax(scale_m * scale_m * covariance.diagonal()).cwiseSqrt();
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
      const double weight = huber_weight(scale_m, residuals_m[i]);
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
  if (!(way > 0.0)) return std::nullopt;  // odometry counts nothing
  // The way of odometry's point is counted with that factor, too: the first two unknowns hold it.
  const Eigen::Vector2d place_m = solution.head<2>() / way;
  const Eigen::Vector4d sigma =
      standard_errors(equations, residuals_m, scale_m, solution, covariance) / way;
  return OdometryPoint{{place_m.x(), place_m.y(), std::atan2(solution(3), solution(2))},
                       {sigma(0), sigma(1), std::hypot(sigma(2), sigma(3)) / M_SQRT2}};
}

}  // namespace slammot::matching
