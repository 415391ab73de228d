#include "common/matching/point_to_line.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace slammot::matching {
namespace {

using geometry::Matrix3;
using geometry::Pose2;

struct NormalEquations {
  Matrix3 H = Matrix3::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  int matched = 0;
  double squared_residuals_m2 = 0.0;

  void add(const Eigen::Vector3d& J, double residual_m, double weight) {
    H.noalias() += weight * J * J.transpose();
    g.noalias() += weight * residual_m * J;
  }
};

/// Weight of Geman and McClure: 1 at zero, a quarter at the scale.
double robust_weight(double residual_m, double scale_m) {
  const double ratio = residual_m / scale_m;
  const double root = 1.0 / (1.0 + ratio * ratio);
  return root * root;
}

NormalEquations linearize(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels, const Pose2& map_from_base,
                          double gate_m, const PointToLineConfig& config) {
  const double cell_m = surfels.window().cell_size_m;
  const int radius = std::max(1, static_cast<int>(std::ceil(gate_m / cell_m - 0.5)));
  const geometry::Matrix2 turn = geometry::rotation(map_from_base.heading_rad);
  NormalEquations equations;
  for (const MatchPoint& point : points) {
    const geometry::Vector2 turned_m = turn * point.in_base_m;
    const geometry::Vector2 at_m = turned_m + map_from_base.translation_m();
    const auto surfel = surfels.nearest(at_m, radius);
    if (!surfel) continue;
    const geometry::Vector2 offset_m = at_m - surfel->mean_m;
    if (offset_m.squaredNorm() > gate_m * gate_m) continue;
    const geometry::Vector2 by_heading_m(-turned_m.y(), turned_m.x());
    const double share = surfel->seen_over_m >= config.proven_after_m ? 1.0 : config.unproven_share;
    const auto add = [&](const geometry::Vector2& direction, double sigma_m) {
      const double residual_m = direction.dot(offset_m);
      const double weight = share * robust_weight(residual_m, config.robust_scale_m) / (sigma_m * sigma_m);
      equations.add({direction.x(), direction.y(), direction.dot(by_heading_m)}, residual_m, weight);
      return residual_m;
    };
    ++equations.matched;
    if (surfel->normal.isZero()) {
      const double sigma_m = point.sigma_m + 0.5 * cell_m;
      equations.squared_residuals_m2 += 0.5 * offset_m.squaredNorm();
      add({1.0, 0.0}, sigma_m);
      add({0.0, 1.0}, sigma_m);
    } else {
      const double residual_m = add(surfel->normal, std::sqrt(point.sigma_m * point.sigma_m + surfel->spread_m2));
      equations.squared_residuals_m2 += residual_m * residual_m;
    }
  }
  equations.H *= config.information_share;
  equations.g *= config.information_share;
  return equations;
}

}  // namespace

PointToLineResult match_point_to_line(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                                      const geometry::UncertainPose2& prior_map_from_base,
                                      const Pose2& initial_map_from_base, const PointToLineConfig& config) {
  const Matrix3 prior_information = prior_map_from_base.covariance.inverse();
  const Pose2& prior = prior_map_from_base.pose;
  PointToLineResult result;
  result.map_from_base = prior_map_from_base;
  Pose2& pose = result.map_from_base.pose;
  pose = initial_map_from_base;
  NormalEquations equations;
  for (int step = 0; step < config.coarse_steps + config.fine_steps; ++step) {
    const bool is_coarse = step < config.coarse_steps;
    equations = linearize(points, surfels, pose, is_coarse ? config.coarse_gate_m : config.fine_gate_m, config);
    const Matrix3 H = equations.H + prior_information;
    const Eigen::Vector3d change = -H.ldlt().solve(equations.g + prior_information * geometry::difference(pose, prior));
    pose = {pose.x_m + change.x(), pose.y_m + change.y(), geometry::wrap_angle(pose.heading_rad + change.z())};
    const double moved_m = change.head<2>().norm() + 10.0 * std::abs(change.z());  // as seen 10 m away
    if (moved_m < config.converged_m) {
      if (!is_coarse) break;
      step = config.coarse_steps - 1;
    }
  }
  if (equations.matched == 0) pose = prior;
  result.scan_information = equations.H;
  result.map_from_base.covariance = (equations.H + prior_information).inverse();
  result.matched_points = equations.matched;
  if (!points.empty()) result.matched_share = static_cast<double>(equations.matched) / static_cast<double>(points.size());
  if (equations.matched > 0) result.rms_residual_m = std::sqrt(equations.squared_residuals_m2 / equations.matched);
  return result;
}

}  // namespace slammot::matching
