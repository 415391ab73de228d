#include "services/collision_warning/encounter.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace slammot::collision_warning {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr std::size_t kQuantiles = 9;
constexpr std::size_t kSamples = kQuantiles * kQuantiles;
/// Normal quantiles at (i + 0.5) / 9, scaled to a variance of 1.
constexpr std::array<double, kQuantiles> kNormal = {-1.7112, -1.0388, -0.6329, -0.3031, 0.0,
                                                    0.3031,  0.6329,  1.0388,  1.7112};
/// No sample is farther out than this many sigma.
constexpr double kFarthestSample = 2.4201;
constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

Vector2d sample(std::size_t index) {
  return {kNormal[index / kQuantiles], kNormal[index % kQuantiles]};
}

/// Symmetric square root of a 2x2 covariance, by Cayley and Hamilton: it does not depend on axes,
/// so that a sample stays on its side from step to step.
Matrix2d root_of(const Matrix2d& covariance) {
  const double root_determinant = std::sqrt(std::max(0.0, covariance.determinant()));
  const double scale = std::sqrt(std::max(0.0, covariance.trace() + 2.0 * root_determinant));
  if (scale < 1e-9) return Matrix2d::Zero();
  return (covariance + root_determinant * Matrix2d::Identity()) / scale;
}

double largest_sigma_m(const Matrix2d& covariance) {
  const double middle = 0.5 * covariance.trace();
  const double spread = std::sqrt(std::max(0.0, middle * middle - covariance.determinant()));
  return std::sqrt(std::max(0.0, middle + spread));
}

/// Step of the first contact of each sample.
std::array<std::size_t, kSamples> first_contacts(const PredictedBoxes& vehicle,
                                                 const PredictedBoxes& object) {
  std::array<std::size_t, kSamples> steps;
  steps.fill(kNever);
  for (std::size_t step = 0; step < vehicle.size(); ++step) {
    const OverlapTest test(vehicle[step].box, object[step].box);
    const Matrix2d covariance_m2 = vehicle[step].covariance_m2 + object[step].covariance_m2;
    if (test.clearance_m() > kFarthestSample * largest_sigma_m(covariance_m2)) continue;
    const Matrix2d root_m = root_of(covariance_m2);
    for (std::size_t i = 0; i < kSamples; ++i) {
      if (steps[i] == kNever && test.overlaps(root_m * sample(i))) steps[i] = step;
    }
  }
  return steps;
}

}  // namespace

std::optional<Contact> contact(const PredictedBoxes& vehicle, const PredictedBoxes& object) {
  assert(vehicle.size() == object.size());
  std::array<std::size_t, kSamples> steps = first_contacts(vehicle, object);
  const auto contacts = static_cast<std::size_t>(
      std::ranges::count_if(steps, [](std::size_t step) { return step != kNever; }));
  if (contacts == 0) return std::nullopt;
  const auto median = steps.begin() + static_cast<std::ptrdiff_t>((contacts - 1) / 2);
  std::ranges::nth_element(steps, median);
  return Contact{static_cast<double>(contacts) / static_cast<double>(kSamples),
                 kPredictionStepS * static_cast<double>(*median)};
}

ClosestApproach closest_approach(const PredictedBoxes& vehicle, const PredictedBoxes& object) {
  assert(vehicle.size() == object.size());
  ClosestApproach closest{std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t step = 0; step < vehicle.size(); ++step) {
    const double here_m = distance_m(vehicle[step].box, object[step].box);
    if (here_m < closest.distance_m)
      closest = {here_m, kPredictionStepS * static_cast<double>(step)};
  }
  return closest;
}

}  // namespace slammot::collision_warning
