#include "common/filters/model_set.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace slammot::filters {
namespace {

/// Moments of the first N entries of the state.
template <int N>
Gaussian<N> moment_match_first(std::span<const MotionState> modes, std::span<const double> weight) {
  assert(modes.size() == weight.size());
  Gaussian<N> mixture{weight[0] * modes[0].mean.head<N>(),
                      weight[0] * modes[0].covariance.topLeftCorner<N, N>()};
  for (std::size_t i = 1; i < modes.size(); ++i) {
    mixture.mean += weight[i] * modes[i].mean.head<N>();
    mixture.covariance += weight[i] * modes[i].covariance.topLeftCorner<N, N>();
    // The spread about the common mean is computed from pairwise differences: half as many
    // products.
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Matrix<double, N, 1> apart = modes[i].mean.head<N>() - modes[j].mean.head<N>();
      mixture.covariance.noalias() += (weight[i] * weight[j] * apart) * apart.transpose();
    }
  }
  return mixture;
}

}  // namespace

ModelWeights equal_weights(const ModelSet& set) {
  assert(set.size >= 1 && set.size <= kMaxModels);
  ModelWeights weight = {};
  for (std::size_t i = 0; i < set.size; ++i) weight[i] = 1.0 / static_cast<double>(set.size);
  return weight;
}

double switch_probability(const ModelSet& set, std::size_t from, std::size_t to, double time_s) {
  if (set.size == 1) return 1.0;
  const double stay = std::exp(-time_s / set.mean_stay_s);
  return from == to ? stay : (1.0 - stay) / static_cast<double>(set.size - 1);
}

MotionState moment_match(std::span<const MotionState> modes, std::span<const double> weight) {
  return moment_match_first<6>(modes, weight);
}

MotionState moment_match_moving(std::span<const MotionState> modes,
                                std::span<const double> weight) {
  const Gaussian<4> moving = moment_match_first<4>(modes, weight);
  MotionState mixture;
  mixture.mean.head<4>() = moving.mean;
  mixture.covariance.topLeftCorner<4, 4>() = moving.covariance;
  return mixture;
}

Gaussian<2> moment_match_position(std::span<const MotionState> modes,
                                  std::span<const double> weight) {
  return moment_match_first<2>(modes, weight);
}

double log_of(double probability) { return std::log(std::max(probability, 1e-300)); }

double normalize_logs(std::span<double> log_weight) {
  const double largest = *std::max_element(log_weight.begin(), log_weight.end());
  double total = 0.0;
  for (double& weight : log_weight) total += weight = std::exp(weight - largest);
  for (double& weight : log_weight) weight /= total;
  return largest + std::log(total);
}

/// kalman_update() with H = (I 0), without multiplications by ones and zeros (imm_cycle in
/// multiple_models_bench.cpp).
KalmanUpdate<6, 2> update_with_position(const MotionState& predicted,
                                        const Eigen::Vector2d& position_m,
                                        const Eigen::Matrix2d& R) {
  using Matrix62 = Eigen::Matrix<double, 6, 2>;
  const Matrix6& P = predicted.covariance;
  const Eigen::Matrix2d S = P.topLeftCorner<2, 2>() + R;
  const Eigen::LLT<Eigen::Matrix2d> root(S);
  const Eigen::Matrix2d& L = root.matrixLLT();
  const Eigen::Array2d unit = 1.0 / L.diagonal().array();
  Matrix62 K;  // P H' by the inverses of L and L'
  K.col(0) = P.col(0) * unit(0);
  K.col(1) = (P.col(1) - K.col(0) * L(1, 0)) * unit(1) * unit(1);
  K.col(0) = (K.col(0) - K.col(1) * L(1, 0)) * unit(0);
  const Matrix62 I_KH = Matrix62::Identity() - K;  // columns that differ from those of I
  Matrix6 I_KH_P = I_KH * P.topRows<2>();
  I_KH_P.bottomRows<4>() += P.bottomRows<4>();
  KalmanUpdate<6, 2> update;
  update.innovation = innovation<2>(position_m - predicted.mean.head<2>(), S, root);
  update.posterior.mean = predicted.mean + K * update.innovation.residual;
  Matrix6& after = update.posterior.covariance;
  after = I_KH_P.leftCols<2>() * I_KH.transpose();
  after.rightCols<4>() += I_KH_P.rightCols<4>();
  // Eigen sums six products in two halves
  after.col(2) = I_KH_P.col(0) * I_KH(2, 0) + (I_KH_P.col(1) * I_KH(2, 1) + I_KH_P.col(2));
  after += K * R * K.transpose();
  return update;
}

}  // namespace slammot::filters
