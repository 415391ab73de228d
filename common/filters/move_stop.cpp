#include "common/filters/move_stop.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace slammot::filters {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

double largest_eigenvalue(const Matrix2d& symmetric) {
  const double half_trace = 0.5 * symmetric.trace();
  return half_trace + std::hypot(0.5 * (symmetric(0, 0) - symmetric(1, 1)), symmetric(0, 1));
}

}  // namespace

Matrix2d StationaryProcess::covariance_m2() const {
  const double freedom = weight - squared_weight / std::max(weight, 1e-12);
  return freedom > 0.0 ? Matrix2d(scatter_m2 / freedom) : Matrix2d::Zero();
}

Matrix2d StationaryProcess::mean_covariance_m2() const {
  constexpr double kUnknownM2 = 1e6;
  if (step_weight <= 0.0) return kUnknownM2 * Matrix2d::Identity();
  const Matrix2d white_m2 = differences_m2 / step_weight;
  const Matrix2d lasting_m2 = covariance_m2() - white_m2;
  const double count = weight * weight / squared_weight;
  return white_m2 / count + std::max(0.0, lasting_m2.trace()) * Matrix2d::Identity();
}

StationaryProcess observed(const StationaryProcess& series, const Vector2d& position_m,
                           double after_s, double memory_s) {
  assert(after_s >= 0.0 && memory_s > 0.0);
  if (series.weight == 0.0)
    return {.weight = 1.0, .squared_weight = 1.0, .mean_m = position_m, .last_m = position_m};
  const double fade = std::exp(-after_s / memory_s);
  StationaryProcess next;
  next.age_s = series.age_s + after_s;
  next.weight = fade * series.weight + 1.0;
  next.squared_weight = fade * fade * series.squared_weight + 1.0;
  next.step_weight = fade * series.step_weight + 1.0;
  const Vector2d off_m = position_m - series.mean_m;
  next.mean_m = series.mean_m + off_m / next.weight;
  next.scatter_m2 =
      fade * series.scatter_m2 + (fade * series.weight / next.weight) * off_m * off_m.transpose();
  const Vector2d step_m = position_m - series.last_m;
  next.differences_m2 = fade * series.differences_m2 + 0.5 * step_m * step_m.transpose();
  next.last_m = position_m;
  return next;
}

double minimum_detection_speed_mps(const MotionState& moving, double sigmas) {
  return sigmas * std::sqrt(largest_eigenvalue(moving.covariance.block<2, 2>(2, 2)));
}

MoveStop weigh(const MoveStop& before, const MoveStopScan& scan, const MoveStopConfig& config) {
  const double speed_mps = scan.moving.mean.segment<2>(2).norm();
  if (speed_mps > minimum_detection_speed_mps(scan.moving, config.detection_sigmas)) return {};
  MoveStop after;
  after.series = observed(before.series, scan.position_m, scan.after_s, config.memory_s);
  // The stop hypothesis is kept until the move hypothesis is twice as certain: the simpler model is
  // preferred where both explain the data, Wang 2004, Section 4.5.
  constexpr double kAsCertain = 4.0;
  const double most_m2 =
      (before.stands ? kAsCertain : 1.0) * scan.moving.covariance.topLeftCorner<2, 2>().trace();
  after.stands =
      after.series.age_s >= config.memory_s && after.series.mean_covariance_m2().trace() < most_m2;
  return after;
}

MotionState estimate_of(const MoveStop& hypotheses, const MotionState& moving) {
  if (!hypotheses.stands) return moving;
  MotionState standing;
  standing.mean.head<2>() = hypotheses.series.mean_m;
  standing.covariance.topLeftCorner<2, 2>() = hypotheses.series.mean_covariance_m2();
  standing.covariance.bottomRightCorner<4, 4>() = moving.covariance.bottomRightCorner<4, 4>();
  return standing;
}

void move_stop_shift(MoveStop& hypotheses, const Vector2d& shift_m) {
  hypotheses.series.mean_m += shift_m;
  hypotheses.series.last_m += shift_m;
}

}  // namespace slammot::filters
