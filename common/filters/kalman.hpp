#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "common/filters/gaussian.hpp"

namespace slammot::filters {

template <int N, int M>
struct KalmanUpdate {
  Gaussian<N> posterior;
  Innovation<M> innovation;
};

/// Pushes the state through a linear motion with additive noise; Wang 2004, Eq. (4.2).
template <int N>
Gaussian<N> kalman_predict(const Gaussian<N>& prior, const Eigen::Matrix<double, N, N>& F,
                           const Eigen::Matrix<double, N, N>& Q) {
  return {F * prior.mean, F * prior.covariance * F.transpose() + Q};
}

/// Conditions the state on a linear measurement z = H x + noise(R). Joseph's form: stays symmetric
/// and positive. H P H' + R must be positive definite.
template <int N, int M>
KalmanUpdate<N, M> kalman_update(const Gaussian<N>& prior, const Eigen::Matrix<double, M, 1>& z,
                                 const Eigen::Matrix<double, M, N>& H,
                                 const Eigen::Matrix<double, M, M>& R) {
  const Eigen::Matrix<double, N, M> PHt = prior.covariance * H.transpose();
  const Eigen::Matrix<double, M, M> S = H * PHt + R;
  const Eigen::Matrix<double, N, M> K = S.llt().solve(PHt.transpose()).transpose();
  const Eigen::Matrix<double, N, N> I_KH = Eigen::Matrix<double, N, N>::Identity() - K * H;
  KalmanUpdate<N, M> update;
  update.innovation = innovation<M>(z - H * prior.mean, S);
  update.posterior.mean = prior.mean + K * update.innovation.residual;
  update.posterior.covariance = I_KH * prior.covariance * I_KH.transpose() + K * R * K.transpose();
  return update;
}

}  // namespace slammot::filters
