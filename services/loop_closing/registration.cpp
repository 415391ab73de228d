#include "services/loop_closing/registration.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/geometry/displacement.hpp"

namespace slammot::loop_closing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;

constexpr int kCoarseSteps = 6;  // Gauss-Newton steps with the wide gate.
constexpr int kFineSteps = 10;   // Gauss-Newton steps with the narrow gate.

// Weak prior at the initial pose, which regularizes unobserved directions. Negligible beside any
// wall.
constexpr double kUnobservedSigmaM = 5.0;
constexpr double kUnobservedSigmaRad = 0.5;

struct NormalEquations {
  Matrix3 H = Matrix3::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  int matched = 0;
  double squared_m2 = 0.0;

  void add(const Eigen::Vector2d& direction, const Eigen::Vector2d& offset_m,
           const Eigen::Vector2d& by_heading_m, double weight) {
    const double residual_m = direction.dot(offset_m);
    const Eigen::Vector3d J(direction.x(), direction.y(), direction.dot(by_heading_m));
    H += weight * J * J.transpose();
    g += weight * residual_m * J;
    squared_m2 += residual_m * residual_m;
  }
};

/// Weight of Geman and McClure: 1 at zero, 1/4 at the scale.
double robust_weight(double residual_m, double scale_m) {
  const double root = 1.0 / (1.0 + residual_m * residual_m / (scale_m * scale_m));
  return root * root;
}

NormalEquations linearize(std::span<const flow::Surfel> source, const SurfelIndex& target,
                          const Pose2& target_from_source, double gate_m, double sigma_m) {
  const Eigen::Matrix2d turn = geometry::rotation(target_from_source.heading_rad);
  NormalEquations equations;
  for (const flow::Surfel& surfel : source) {
    const Eigen::Vector2d turned_m = turn * Eigen::Vector2d(surfel.x_m, surfel.y_m);
    const Eigen::Vector2d at_m = turned_m + target_from_source.translation_m();
    const Eigen::Vector2d normal = turn * Eigen::Vector2d(surfel.normal_x, surfel.normal_y);
    const flow::Surfel* pair =
        target.nearest(at_m.cast<float>(), normal.cast<float>(), static_cast<float>(gate_m));
    if (pair == nullptr) continue;
    const Eigen::Vector2d offset_m = at_m - Eigen::Vector2d(pair->x_m, pair->y_m);
    const Eigen::Vector2d by_heading_m(-turned_m.y(), turned_m.x());
    const Eigen::Vector2d pair_normal(pair->normal_x, pair->normal_y);
    ++equations.matched;
    if (!pair_normal.isZero()) {
      const double weight =
          robust_weight(pair_normal.dot(offset_m), 0.5 * gate_m) / (sigma_m * sigma_m);
      equations.add(pair_normal, offset_m, by_heading_m, weight);
    } else {
      // A surfel without a normal (a pole): its mean is as uncertain as its cell is wide, equally
      // in all directions.
      const double weight =
          0.25 * robust_weight(offset_m.norm(), 0.5 * gate_m) / (sigma_m * sigma_m);
      equations.add(Eigen::Vector2d::UnitX(), offset_m, by_heading_m, weight);
      equations.add(Eigen::Vector2d::UnitY(), offset_m, by_heading_m, weight);
    }
  }
  return equations;
}

Matrix3 weak_prior() {
  return Eigen::Vector3d(1.0 / (kUnobservedSigmaM * kUnobservedSigmaM),
                         1.0 / (kUnobservedSigmaM * kUnobservedSigmaM),
                         1.0 / (kUnobservedSigmaRad * kUnobservedSigmaRad))
      .asDiagonal();
}

}  // namespace

Registration register_surfels(std::span<const flow::Surfel> source, const SurfelIndex& target,
                              const Pose2& initial_target_from_source,
                              const RegistrationConfig& config) {
  constexpr double kConvergedM = 1e-4;
  Pose2 pose = initial_target_from_source;
  NormalEquations equations;
  for (int step = 0; step < kCoarseSteps + kFineSteps; ++step) {
    const bool is_coarse = step < kCoarseSteps;
    equations =
        linearize(source, target, pose, is_coarse ? coarse_gate_m(config) : config.fine_gate_m,
                  config.surfel_sigma_m);
    const Eigen::Vector3d change = -(config.independent_share * equations.H + weak_prior())
                                        .ldlt()
                                        .solve(config.independent_share * equations.g);
    pose = geometry::displaced(pose, change);
    const bool has_converged = geometry::as_seen_10_m_away(change) < kConvergedM;
    if (has_converged && !is_coarse) break;
    if (has_converged) step = kCoarseSteps - 1;
  }
  Registration registration;
  registration.target_from_source.pose = pose;
  registration.matched_share =
      source.empty() ? 0.0
                     : static_cast<double>(equations.matched) / static_cast<double>(source.size());
  registration.rms_m = std::sqrt(equations.squared_m2 / std::max(equations.matched, 1));
  const double inflation = std::max(1.0, std::pow(registration.rms_m / config.surfel_sigma_m, 2));
  Matrix3& covariance = registration.target_from_source.covariance;
  covariance =
      Matrix3((config.independent_share / inflation * equations.H + weak_prior()).inverse());
  covariance.diagonal() += Eigen::Vector3d(config.position_floor_m * config.position_floor_m,
                                           config.position_floor_m * config.position_floor_m,
                                           config.heading_floor_rad * config.heading_floor_rad);
  return registration;
}

}  // namespace slammot::loop_closing
