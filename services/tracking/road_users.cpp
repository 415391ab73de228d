#include "services/tracking/road_users.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {
namespace {

// Half of the variance of a size anywhere is between the means of places, half within a place.
constexpr double kWithinShare = 0.5;
constexpr double kSpreadWorth = 4.0;      ///< Weight of the prior of the spread, in road users.
constexpr double kElsewhereShare = 0.05;  ///< Share of road users here that are like those
                                          ///< anywhere.
constexpr double kLeastSigmaShare = 0.1;  ///< Floor of the learned sigma.

// Counted: docs/decisions/object-covariance.md. Echoes of exact boxes have a distance from the
// sides, too: the noise of the scanner.
constexpr double kOffSidesOfBoxes = 0.25;
constexpr double kOffSidesAsTaken = 0.75;
constexpr double kShapeWorth = 2.0;             ///< Weight of the prior, in road users.
constexpr double kSwingWorth = 2.0;             ///< Weight of the configured gait, in pedestrians.
constexpr double kLeastShapeShare = 1.0 / 3.0;  ///< Errors in bends and of the sizes remain for
                                                ///< exact boxes.

}  // namespace

void RoadUsersSeen::Sample::add(const Size& seen) {
  count += 1.0;
  const double off_m = seen.value_m - mean_m;
  mean_m += off_m / count;
  squares_m2 += off_m * (seen.value_m - mean_m);
  error_m2 += seen.variance_m2;
}

double RoadUsersSeen::Sample::true_squares_m2() const {
  return count > 1.0 ? std::max(0.0, squares_m2 - degrees() * error_m2 / count) : 0.0;
}

/// Variance of sizes here relative to anywhere, common to all kinds: where cars are alike, trucks
/// probably are, too.
double RoadUsersSeen::spread_share() const {
  double squares = kSpreadWorth * kWithinShare;
  double degrees = kSpreadWorth;
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    squares += sizes_[i].length.true_squares_m2() / std::pow(kKinds[i].length_sigma_m, 2) +
               sizes_[i].width.true_squares_m2() / std::pow(kKinds[i].width_sigma_m, 2);
    degrees += sizes_[i].length.degrees() + sizes_[i].width.degrees();
  }
  return squares / degrees;
}

/// Prediction of the next road user's size.
Size RoadUsersSeen::next(const Sample& sample, double mean_m, double sigma_m, double spread_share) {
  const double variance_m2 = sigma_m * sigma_m;
  const double within_m2 = (kSpreadWorth * spread_share * variance_m2 + sample.true_squares_m2()) /
                           (kSpreadWorth + sample.degrees());
  const double between_m2 = (1.0 - kWithinShare) * variance_m2;
  const double of_mean_m2 =
      sample.count > 0.0 ? (within_m2 + sample.error_m2 / sample.count) / sample.count : 0.0;
  const double gain = sample.count > 0.0 ? between_m2 / (between_m2 + of_mean_m2) : 0.0;
  return {mean_m + gain * (sample.mean_m - mean_m),
          std::max(within_m2 + (1.0 - gain) * between_m2, std::pow(kLeastSigmaShare * sigma_m, 2))};
}

double RoadUsersSeen::shape_share() const {
  const double outline_error =
      (kShapeWorth * kOffSidesAsTaken + off_sides_share_.count * off_sides_share_.mean_m) /
      (kShapeWorth + off_sides_share_.count);
  return std::clamp((outline_error - kOffSidesOfBoxes) / (kOffSidesAsTaken - kOffSidesOfBoxes),
                    kLeastShapeShare, 1.0);
}

double RoadUsersSeen::swing_share() const {
  return std::min(1.0, (kSwingWorth + swing_share_.count * swing_share_.mean_m) /
                           (kSwingWorth + swing_share_.count));
}

RoadUsers RoadUsersSeen::known() const {
  RoadUsers here;
  const double share = spread_share();
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    const Size length = next(sizes_[i].length, kKinds[i].length_m, kKinds[i].length_sigma_m, share);
    const Size width = next(sizes_[i].width, kKinds[i].width_m, kKinds[i].width_sigma_m, share);
    here.kinds[i] = {kKinds[i].kind, (1.0 - kElsewhereShare) * kKinds[i].share,
                     length.value_m, std::sqrt(length.variance_m2),
                     width.value_m,  std::sqrt(width.variance_m2)};
    here.kinds[kKinds.size() + i] = {kKinds[i].kind,     kElsewhereShare * kKinds[i].share,
                                     kKinds[i].length_m, kKinds[i].length_sigma_m,
                                     kKinds[i].width_m,  kKinds[i].width_sigma_m};
  }
  here.corner = next(corner_, kCorner.value_m, std::sqrt(kCorner.variance_m2), kWithinShare);
  here.shape_share = shape_share();
  here.swing_share = swing_share();
  return here;
}

}  // namespace slammot::tracking
