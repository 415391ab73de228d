#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace slammot::filters {

/// Normal distribution over a state of N numbers.
template <int N>
struct Gaussian {
  Eigen::Matrix<double, N, 1> mean = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, N> covariance = Eigen::Matrix<double, N, N>::Zero();
};

/// Innovation of a measurement against a prediction.
template <int M>
struct Innovation {
  /// Measured minus predicted.
  Eigen::Matrix<double, M, 1> residual = Eigen::Matrix<double, M, 1>::Zero();
  Eigen::Matrix<double, M, M> covariance = Eigen::Matrix<double, M, M>::Identity();
  double nis = 0.0;  ///< Normalized innovation squared; chi-square with M degrees of freedom if the
                     ///< filter is consistent.
  double log_likelihood = 0.0;  ///< Natural logarithm of the density of the measurement.
};

/// Innovation of a residual whose covariance has this Cholesky factor.
template <int M>
Innovation<M> innovation(const Eigen::Matrix<double, M, 1>& residual,
                         const Eigen::Matrix<double, M, M>& covariance,
                         const Eigen::LLT<Eigen::Matrix<double, M, M>>& root) {
  const Eigen::Matrix<double, M, 1> white = root.matrixL().solve(residual);
  const double log_root_determinant = root.matrixLLT().diagonal().array().log().sum();
  const double nis = white.squaredNorm();
  return {residual, covariance, nis,
          -0.5 * (nis + M * std::log(2.0 * std::numbers::pi)) - log_root_determinant};
}

/// The same; the covariance must be positive definite.
template <int M>
Innovation<M> innovation(const Eigen::Matrix<double, M, 1>& residual,
                         const Eigen::Matrix<double, M, M>& covariance) {
  return innovation<M>(residual, covariance, Eigen::LLT<Eigen::Matrix<double, M, M>>(covariance));
}

}  // namespace slammot::filters
