#pragma once

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace slammot::association {

/// Squared Mahalanobis distance of a residual; the covariance is positive definite. Wang 2004, Eq.
/// (5.8).
template <int M>
double mahalanobis_squared(const Eigen::Matrix<double, M, 1>& residual,
                           const Eigen::Matrix<double, M, M>& covariance) {
  return residual.dot(covariance.llt().solve(residual));
}

/// Gate [squared Mahalanobis distance] that accepts the given share (in (0, 1)) of true pairs in
/// the plane; Wang 2004, Eq. (5.9). It is the quantile of chi-square with two degrees of freedom,
/// in closed form.
inline double planar_gate(double share) { return -2.0 * std::log(1.0 - share); }

}  // namespace slammot::association
