#include "examples/joint_posterior/joint_filter.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace slammot::joint_posterior {
namespace {

using geometry::Pose2;

/// A Gaussian of the whole state.
struct Belief {
  Eigen::VectorXd mean;
  Eigen::MatrixXd P;
};

/// Expected observation and its derivatives by pose and place.
struct Expected {
  Eigen::Vector2d range_bearing;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_place;
};

Expected expected_at(const Eigen::VectorXd& mean, Eigen::Index at) {
  const Eigen::Vector2d away_m = mean.segment<2>(at) - mean.head<2>();
  const double range_m = std::max(away_m.norm(), 1e-3);
  Expected expected;
  expected.range_bearing = {range_m,
                            geometry::wrap_angle(std::atan2(away_m.y(), away_m.x()) - mean[2])};
  const Eigen::Vector2d direction = away_m / range_m;
  expected.by_place << direction.x(), direction.y(), -direction.y() / range_m,
      direction.x() / range_m;
  expected.by_pose << -expected.by_place, Eigen::Vector2d(0.0, -1.0);
  return expected;
}

/// Kalman update of the whole state; returns the likelihood of the observation.
double update_belief(Belief& belief, Eigen::Index at, const Eigen::Vector2d& range_bearing) {
  const Expected expected = expected_at(belief.mean, at);
  Eigen::Vector2d innovation = range_bearing - expected.range_bearing;
  innovation[1] = geometry::wrap_angle(innovation[1]);
  const Eigen::Matrix<double, Eigen::Dynamic, 2> PHt =
      belief.P.leftCols<3>() * expected.by_pose.transpose() +
      belief.P.middleCols<2>(at) * expected.by_place.transpose();
  const Eigen::Matrix2d S = expected.by_pose * PHt.topRows<3>() +
                            expected.by_place * PHt.middleRows<2>(at) + observation_covariance();
  const Eigen::Matrix<double, Eigen::Dynamic, 2> K = PHt * S.inverse();
  belief.mean += K * innovation;
  belief.mean[2] = geometry::wrap_angle(belief.mean[2]);
  belief.P.noalias() -= K * PHt.transpose();
  belief.P = (0.5 * (belief.P + belief.P.transpose())).eval();
  return std::exp(-0.5 * innovation.dot(S.ldlt().solve(innovation))) / std::sqrt(S.determinant());
}

/// The belief after one period in which the object moved as in this mode.
void predict_object(Belief& belief, Eigen::Index at, Mode mode) {
  const auto& [F, Q] = model_of(mode);
  belief.mean.segment<4>(at) = (F * belief.mean.segment<4>(at)).eval();
  belief.P.middleRows<4>(at) = (F * belief.P.middleRows<4>(at)).eval();
  belief.P.middleCols<4>(at) = (belief.P.middleCols<4>(at) * F.transpose()).eval();
  belief.P.block<4, 4>(at, at) += Q;
}

/// Moment-matched mixture.
Belief merged(const std::array<Belief, kModes>& modes, const ModeWeights& weights) {
  Eigen::VectorXd apart = modes[kMoving].mean - modes[kStationary].mean;
  apart[2] = geometry::wrap_angle(apart[2]);
  Belief all{modes[kStationary].mean + weights[kMoving] * apart,
             weights[kStationary] * modes[kStationary].P + weights[kMoving] * modes[kMoving].P};
  all.mean[2] = geometry::wrap_angle(all.mean[2]);
  all.P.noalias() += weights[kStationary] * weights[kMoving] * apart * apart.transpose();
  return all;
}

}  // namespace

Eigen::Matrix2d observation_covariance() {
  return Eigen::Vector2d(kRangeSigma_m * kRangeSigma_m, kBearingSigma_rad * kBearingSigma_rad)
      .asDiagonal();
}

ObservedPlace observed_place(const Pose2& world_from_base, const Eigen::Vector2d& range_bearing) {
  const double direction_rad = world_from_base.heading_rad + range_bearing[1];
  const Eigen::Vector2d direction{std::cos(direction_rad), std::sin(direction_rad)};
  const Eigen::Vector2d away_m = range_bearing[0] * direction;
  const Eigen::Vector2d by_turn{-away_m.y(), away_m.x()};
  ObservedPlace observed;
  observed.place_m = world_from_base.translation_m() + away_m;
  observed.by_pose << Eigen::Matrix2d::Identity(), by_turn;
  observed.by_observation << direction, by_turn;
  return observed;
}

JointFilter::JointFilter() : mean_(Eigen::VectorXd::Zero(3)), P_(Eigen::MatrixXd::Zero(3, 3)) {}

std::size_t JointFilter::add(ObjectKind kind, const Eigen::Vector2d& range_bearing) {
  const Eigen::Index old = mean_.size();
  const Eigen::Index numbers = kind == ObjectKind::kLandmark ? 2 : 4;
  mean_.conservativeResize(old + numbers);
  Eigen::MatrixXd grown = Eigen::MatrixXd::Zero(old + numbers, old + numbers);
  grown.topLeftCorner(old, old) = P_;
  P_ = std::move(grown);
  Object object;
  object.kind = kind;
  object.at = old;
  objects_.push_back(object);
  place(objects_.back(), range_bearing);
  return objects_.size() - 1;
}

void JointFilter::place(Object& object, const Eigen::Vector2d& range_bearing) {
  const Eigen::Index at = object.at;
  const Eigen::Index numbers = object.kind == ObjectKind::kLandmark ? 2 : 4;
  const ObservedPlace observed = observed_place(world_from_base(), range_bearing);
  const Eigen::Matrix2d own =
      observed.by_observation * observation_covariance() * observed.by_observation.transpose();
  const ObjectEstimate begun = begin_at(
      observed.place_m, own + observed.by_pose * pose_covariance() * observed.by_pose.transpose());
  mean_.segment(at, numbers) = begun.mean.head(numbers);
  P_.middleRows(at, numbers).setZero();
  P_.middleCols(at, numbers).setZero();
  const Eigen::Matrix<double, 2, Eigen::Dynamic> cross = observed.by_pose * P_.topRows<3>();
  P_.middleRows<2>(at) = cross;
  P_.middleCols<2>(at) = cross.transpose();
  P_.block(at, at, numbers, numbers) = begun.covariance.topLeftCorner(numbers, numbers);
  object.weights = kUnknownMode;
  object.is_due = false;
}

void JointFilter::predict(const Control& control) {
  for (Object& object : objects_) {
    if (object.is_due) predict_unobserved(object);
    object.is_due = object.kind == ObjectKind::kGeneric;
  }
  predict_pose(control);
}

void JointFilter::predict_pose(const Control& control) {
  const Pose2 before = world_from_base();
  const Pose2 after = moved(before, control);
  const double middle_rad = before.heading_rad + 0.5 * control.turn_radps * kPeriod_s;
  const double way_m = control.speed_mps * kPeriod_s;
  const Eigen::Vector2d along{std::cos(middle_rad), std::sin(middle_rad)};
  const Eigen::Vector2d across{-along.y(), along.x()};
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.topRightCorner<2, 1>() = way_m * across;
  Eigen::Matrix<double, 3, 2> by_control;
  by_control << kPeriod_s * along, 0.5 * kPeriod_s * way_m * across, 0.0, kPeriod_s;
  const Eigen::Matrix2d control_covariance =
      Eigen::Vector2d(kSpeedSigma_mps * kSpeedSigma_mps, kTurnSigma_radps * kTurnSigma_radps)
          .asDiagonal();
  mean_.head<3>() << after.x_m, after.y_m, after.heading_rad;
  P_.topRows<3>() = (F * P_.topRows<3>()).eval();
  P_.leftCols<3>() = (P_.leftCols<3>() * F.transpose()).eval();
  P_.topLeftCorner<3, 3>() += by_control * control_covariance * by_control.transpose();
}

void JointFilter::predict_unobserved(Object& object) {
  object.weights = switched(object.weights);
  std::array<Belief, kModes> modes;
  for (const Mode mode : {kStationary, kMoving}) {
    modes[mode] = {mean_, P_};
    predict_object(modes[mode], object.at, mode);
  }
  Belief all = merged(modes, object.weights);
  mean_ = std::move(all.mean);
  P_ = std::move(all.P);
  object.is_due = false;
}

void JointFilter::update(std::size_t index, const Eigen::Vector2d& range_bearing) {
  // A place less certain than this makes its observation too far from linear.
  const double lost_m = 0.5 + 0.05 * range_bearing[0];
  Object& object = objects_[index];
  if (P_.block<2, 2>(object.at, object.at).trace() > 2.0 * lost_m * lost_m)
    return place(object, range_bearing);
  if (object.is_due) return update_with_modes(object, range_bearing);
  Belief belief{std::move(mean_), std::move(P_)};
  update_belief(belief, object.at, range_bearing);
  mean_ = std::move(belief.mean);
  P_ = std::move(belief.P);
}

/// GPB1 over the modes of one object, in the joint state.
void JointFilter::update_with_modes(Object& object, const Eigen::Vector2d& range_bearing) {
  object.weights = switched(object.weights);
  std::array<Belief, kModes> modes;
  double sum = 0.0;
  for (const Mode mode : {kStationary, kMoving}) {
    modes[mode] = {mean_, P_};
    predict_object(modes[mode], object.at, mode);
    object.weights[mode] *= update_belief(modes[mode], object.at, range_bearing);
    sum += object.weights[mode];
  }
  if (sum > 0.0) {
    for (double& weight : object.weights) weight /= sum;
  } else {
    object.weights = kUnknownMode;
  }
  Belief all = merged(modes, object.weights);
  mean_ = std::move(all.mean);
  P_ = std::move(all.P);
  object.is_due = false;
}

ObjectEstimate JointFilter::estimate(std::size_t index) const {
  const auto& [kind, at, weights, is_due] = objects_[index];
  const Eigen::Index numbers = kind == ObjectKind::kLandmark ? 2 : 4;
  ObjectEstimate estimate;
  estimate.mean.head(numbers) = mean_.segment(at, numbers);
  estimate.covariance.topLeftCorner(numbers, numbers) = P_.block(at, at, numbers, numbers);
  return estimate;
}

}  // namespace slammot::joint_posterior
