#include "common/matching/smear_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::matching {
namespace {

constexpr std::int32_t kPhases = 4;    // tabulated subcell positions, in each axis
constexpr double kKernelSigmas = 3.0;  // exp(-4.5) = 0.011: below the grid's useful resolution

}  // namespace

SmearKernel::SmearKernel(double cell_m, double sigma_m)
    : half_(static_cast<std::int32_t>(std::ceil(kKernelSigmas * sigma_m / cell_m - 1e-9))) {
  for (std::int32_t phase_y = 0; phase_y < kPhases; ++phase_y) {
    for (std::int32_t phase_x = 0; phase_x < kPhases; ++phase_x)
      append(phase_x, phase_y, cell_m / sigma_m);
  }
}

void SmearKernel::append(std::int32_t phase_x, std::int32_t phase_y, double sigmas_per_cell) {
  const double point_x = (phase_x + 0.5) / kPhases - 0.5;  // in cells from the centre of the cell
                                                           // it lies in
  const double point_y = (phase_y + 0.5) / kPhases - 0.5;
  for (std::int32_t row = -half_; row <= half_; ++row) {
    for (std::int32_t column = -half_; column <= half_; ++column) {
      const double sigmas = sigmas_per_cell * std::hypot(column - point_x, row - point_y);
      values_.push_back(
          static_cast<std::uint8_t>(std::lround(kFull * std::exp(-0.5 * sigmas * sigmas))));
    }
  }
}

const std::uint8_t* SmearKernel::around(const geometry::Vector2& fraction) const {
  const auto phase = [](double cells) {
    return std::clamp(static_cast<std::int32_t>(kPhases * cells), 0, kPhases - 1);
  };
  const std::int32_t side = 2 * half_ + 1;
  return values_.data() + (phase(fraction.y()) * kPhases + phase(fraction.x())) * side * side;
}

}  // namespace slammot::matching
