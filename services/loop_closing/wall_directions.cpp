#include "services/loop_closing/wall_directions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace slammot::loop_closing {
namespace {

constexpr std::array kSmoothing{0.25, 0.6, 1.0, 0.6, 0.25};  // Normals have errors of some degrees.
constexpr double kLeastShare = 0.6;                          // Of the greatest correlation.

std::size_t bin_of(double angle_rad, std::size_t bins) {
  const double turns = angle_rad / std::numbers::pi;
  return static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(bins)) % bins;
}

}  // namespace

WallDirections::WallDirections(std::span<const flow::Surfel> surfels) {
  std::array<double, kBins> counts{};
  for (const flow::Surfel& surfel : surfels) {
    if (surfel.normal_x != 0.0F || surfel.normal_y != 0.0F)
      counts[bin_of(std::atan2(surfel.normal_y, surfel.normal_x), kBins)] += 1.0;
  }
  constexpr double kLeastWallShare = 0.4;
  const double walls = std::accumulate(counts.begin(), counts.end(), 0.0);
  has_walls_ = walls > 0.0 && walls >= kLeastWallShare * static_cast<double>(surfels.size());
  double squared_norm = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    for (std::size_t i = 0; i < kSmoothing.size(); ++i)
      shares_[bin] += kSmoothing[i] * counts[(bin + kBins + i - kSmoothing.size() / 2) % kBins];
    squared_norm += shares_[bin] * shares_[bin];
  }
  if (squared_norm == 0.0) return;
  for (double& share : shares_) share /= std::sqrt(squared_norm);
}

double WallDirections::correlation(const WallDirections& turned, double by_rad) const {
  const std::size_t shift =
      bin_of(by_rad + 0.5 * std::numbers::pi / static_cast<double>(kBins), kBins);
  double sum = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin)
    sum += shares_[(bin + shift) % kBins] * turned.shares_[bin];
  return sum;
}

PlausibleHeadings::PlausibleHeadings(const WallDirections& target, const WallDirections& source)
    : target_(target), source_(source) {
  if (!target.has_walls() || !source.has_walls()) return;
  constexpr int kTurns = 90;
  double best = 0.0;
  for (int turn = 0; turn < kTurns; ++turn)
    best = std::max(best, target_.correlation(source_, std::numbers::pi * turn / kTurns));
  least_correlation_ = kLeastShare * best;
}

bool PlausibleHeadings::contains(double heading_rad) const {
  return least_correlation_ == 0.0 ||
         target_.correlation(source_, heading_rad) >= least_correlation_;
}

}  // namespace slammot::loop_closing
