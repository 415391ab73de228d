#include "examples/motion_study/scores.hpp"

#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>

namespace slammot::motion_study {
namespace {

using simulation::Maneuver;
using simulation::MotionMode;

bool can_stand(Method method) {
  return method == Method::kMoveStop || method == Method::kImmWithStop;
}

double nees(const Eigen::Vector2d& error, const Eigen::Matrix2d& covariance) {
  return error.dot(covariance.llt().solve(error));
}

void add(const Sample& sample, Score& sum) {
  const filters::MotionState& state = sample.estimate.state;
  const simulation::MotionVector error = sample.truth - state.mean;
  sum.position_rmse_m += error.head<2>().squaredNorm();
  sum.velocity_rmse_mps += error.segment<2>(2).squaredNorm();
  sum.position_nees += nees(error.head<2>(), state.covariance.topLeftCorner<2, 2>());
  sum.velocity_nees += nees(error.segment<2>(2), state.covariance.block<2, 2>(2, 2));
}

/// Delay of one change in one run.
double delay_s(const std::vector<Sample>& samples, double from_s, double until_s,
               MotionMode wanted) {
  for (const Sample& sample : samples) {
    if (sample.time_s <= from_s || sample.time_s > until_s) continue;
    if (sample.estimate.mode() == wanted) return sample.time_s - from_s;
  }
  return until_s - from_s;
}

double until_next_change_s(const Maneuver& maneuver, std::size_t change) {
  return change + 1 < maneuver.changes.size() ? maneuver.changes[change + 1].time_s
                                              : maneuver.duration_s;
}

}  // namespace

std::vector<Sample> run(Method method, const Maneuver& maneuver, std::uint64_t seed) {
  filters::MotionState start;
  start.mean.head<2>() = maneuver.state_at(0.0).head<2>();
  start.covariance.diagonal() << 0.01, 0.01, 100.0, 100.0, 25.0, 25.0;
  Estimator estimator(method, start);
  std::vector<Sample> samples;
  for (const Eigen::Vector2d& position_m : simulation::measured_positions_m(maneuver, seed)) {
    const double time_s = static_cast<double>(samples.size() + 1) * simulation::kManeuverPeriodS;
    samples.push_back(
        {time_s, maneuver.state_at(time_s), position_m, estimator.update(position_m)});
  }
  return samples;
}

Score score_of(Method method, const Maneuver& maneuver, const Span& span, int seeds) {
  Score sum;
  double count = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    for (const Sample& sample : run(method, maneuver, static_cast<std::uint64_t>(seed))) {
      if (sample.time_s <= span.from_s || sample.time_s > span.until_s) continue;
      add(sample, sum);
      count += 1.0;
    }
  }
  return {std::sqrt(sum.position_rmse_m / count), std::sqrt(sum.velocity_rmse_mps / count),
          sum.position_nees / count, sum.velocity_nees / count};
}

std::optional<double> mode_delay_s(Method method, const Maneuver& maneuver, int seeds) {
  if (filters_of(method) == 1 || maneuver.changes.empty()) return std::nullopt;
  double sum_s = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto samples = run(method, maneuver, static_cast<std::uint64_t>(seed));
    for (std::size_t i = 0; i < maneuver.changes.size(); ++i) {
      MotionMode wanted = maneuver.changes[i].mode;
      if (wanted == MotionMode::kStands && !can_stand(method)) wanted = MotionMode::kCruises;
      sum_s +=
          delay_s(samples, maneuver.changes[i].time_s, until_next_change_s(maneuver, i), wanted);
    }
  }
  return sum_s / (seeds * static_cast<double>(maneuver.changes.size()));
}

}  // namespace slammot::motion_study
