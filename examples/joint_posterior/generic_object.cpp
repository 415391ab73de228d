#include "examples/joint_posterior/generic_object.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "examples/joint_posterior/world.hpp"

namespace slammot::joint_posterior {
namespace {

constexpr double kAcceleration_mps2 = 0.7;  // Of the moving mode, one sigma an axis and period.
constexpr double kNewSpeed_mps = 4.0;       // One sigma of an unknown velocity.
constexpr double kStay_s = 20.0;            // Mean time in a mode.

/// The place stays; the velocity is the one with which the object will go on: zero on average, and
/// unknown.
ModeModel stationary_model() {
  ModeModel model{Eigen::Matrix4d::Zero(), Eigen::Matrix4d::Zero()};
  model.F.topLeftCorner<2, 2>().setIdentity();
  model.Q.bottomRightCorner<2, 2>() = kNewSpeed_mps * kNewSpeed_mps * Eigen::Matrix2d::Identity();
  return model;
}

/// The acceleration is constant within a period.
ModeModel moving_model() {
  ModeModel model{Eigen::Matrix4d::Identity(), Eigen::Matrix4d::Zero()};
  model.F.topRightCorner<2, 2>() = kPeriod_s * Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 4, 2> gain;
  gain << 0.5 * kPeriod_s * kPeriod_s * Eigen::Matrix2d::Identity(),
      kPeriod_s * Eigen::Matrix2d::Identity();
  model.Q = kAcceleration_mps2 * kAcceleration_mps2 * gain * gain.transpose();
  return model;
}

}  // namespace

const ModeModel& model_of(Mode mode) {
  static const std::array<ModeModel, kModes> kModels{stationary_model(), moving_model()};
  return kModels[mode];
}

ModeWeights switched(const ModeWeights& weights) {
  static const double kSwitch = 1.0 - std::exp(-kPeriod_s / kStay_s);
  return {(1.0 - kSwitch) * weights[0] + kSwitch * weights[1],
          (1.0 - kSwitch) * weights[1] + kSwitch * weights[0]};
}

ObjectEstimate begin_at(const Eigen::Vector2d& place_m, const Eigen::Matrix2d& covariance_m2) {
  ObjectEstimate estimate;
  estimate.mean.head<2>() = place_m;
  estimate.covariance.topLeftCorner<2, 2>() = covariance_m2;
  estimate.covariance.bottomRightCorner<2, 2>() =
      kNewSpeed_mps * kNewSpeed_mps * Eigen::Matrix2d::Identity();
  return estimate;
}

ObjectEstimate merged(const std::array<ObjectEstimate, kModes>& modes, const ModeWeights& weights) {
  ObjectEstimate result;
  for (std::size_t i = 0; i < kModes; ++i) result.mean += weights[i] * modes[i].mean;
  for (std::size_t i = 0; i < kModes; ++i) {
    const ObjectState spread = modes[i].mean - result.mean;
    result.covariance += weights[i] * (modes[i].covariance + spread * spread.transpose());
  }
  return result;
}

void HybridTrack::predict() {
  weights = switched(weights);
  for (const Mode mode : {kStationary, kMoving}) {
    const auto& [F, Q] = model_of(mode);
    predicted[mode] = {F * estimate.mean, F * estimate.covariance * F.transpose() + Q};
  }
}

void HybridTrack::update(const Eigen::Vector2d& place_m, const Eigen::Matrix2d& covariance_m2) {
  double sum = 0.0;
  for (const Mode mode : {kStationary, kMoving}) {
    ObjectEstimate& one = predicted[mode];
    const Eigen::Matrix2d S = one.covariance.topLeftCorner<2, 2>() + covariance_m2;
    const Eigen::Vector2d innovation = place_m - one.mean.head<2>();
    const Eigen::Matrix<double, 4, 2> K = one.covariance.leftCols<2>() * S.inverse();
    weights[mode] *=
        std::exp(-0.5 * innovation.dot(S.ldlt().solve(innovation))) / std::sqrt(S.determinant());
    sum += weights[mode];
    one.mean += K * innovation;
    one.covariance -= K * S * K.transpose();
  }
  for (double& weight : weights) weight = sum > 0.0 ? weight / sum : 1.0 / kModes;
  miss();
}

void HybridTrack::miss() { estimate = merged(predicted, weights); }

}  // namespace slammot::joint_posterior
