#include "common/sensing/step_history.hpp"

#include <algorithm>
#include <cmath>

#include "common/sensing/odometry_belief.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using geometry::UncertainPose2;

constexpr double kKernel_m = 0.06;     // one sigma of a kernel at zero step,
constexpr double kKernelShare = 0.12;  // growth with the way
constexpr double kKernel_rad = 0.06;
constexpr double kKernelTurnShare = 0.12;  // and with the turn
constexpr double kWideSteps = 3.0;

Pose2 mirrored(const Pose2& step) { return {step.x_m, -step.y_m, -step.heading_rad}; }

UncertainPose2 kernel_about(const UncertainPose2& before, const Pose2& step) {
  const double sigma_m = kKernel_m + kKernelShare * step.translation_m().norm();
  const double sigma_rad = kKernel_rad + kKernelTurnShare * std::abs(step.heading_rad);
  UncertainPose2 kernel{before.pose * step, before.covariance};
  kernel.covariance.diagonal() += Eigen::Vector3d(sigma_m, sigma_m, sigma_rad).cwiseAbs2();
  return kernel;
}

double log_sum(double a, double b) {
  const double most = std::max(a, b);
  return most + std::log1p(std::exp(std::min(a, b) - most));
}

}  // namespace

void StepHistory::add(const Pose2& before_from_base) {
  steps_[next_] = before_from_base;
  next_ = (next_ + 1) % kKept;
  size_ = std::min(size_ + 1, kKept);
}

double StepHistory::log_marginal(const UncertainPose2& before, const UncertainPose2& wide,
                                 const Pose2& optimum, const geometry::Matrix3& information) const {
  double sum = std::log(kWideSteps) + log_marginal_likelihood(wide, optimum, information);
  const double half = std::log(0.5);
  for (std::size_t i = 0; i < size_; ++i) {
    for (const Pose2& step : {steps_[i], mirrored(steps_[i])})
      sum = log_sum(
          sum, half + log_marginal_likelihood(kernel_about(before, step), optimum, information));
  }
  return sum - std::log(kWideSteps + static_cast<double>(size_));
}

bool StepHistory::is_sound() const {
  return size_ <= kKept && next_ < kKept && std::ranges::all_of(steps_, [](const Pose2& step) {
           return std::isfinite(step.x_m) && std::isfinite(step.y_m) &&
                  std::isfinite(step.heading_rad);
         });
}

}  // namespace slammot::sensing
