#pragma once

#include <span>

namespace slammot::matching {

/// A turn [rad] or a way [m] by scans and by odometry.
struct TwiceMeasured {
  double by_scans = 0.0;
  double sigma = 1.0;  ///< One sigma of the former.
  double by_odometry = 0.0;
};

/// Squared error, in sigmas, of quantities by odometry against those by scans, up to a common
/// factor: with the one that fits best, of a prior of 1 +- factor_sigma. Large errors of single
/// ones are limited.
double error_with_best_factor(std::span<const TwiceMeasured> quantities, double factor_sigma);

/// A turn or a way by odometry that is read at a delay.
struct DelayedQuantity {
  double by_odometry = 0.0;
  double change_per_s = 0.0;  ///< With the delay.
  double sigma = 1.0;         ///< Of the same by scans.
};

/// Information about the delay [1/s^2] in quantities of one kind: how much they change with it,
/// beyond what a common factor explains. Of a vehicle that drives evenly there is none, whatever
/// the curve of errors looks like.
double information_about_delay(std::span<const DelayedQuantity> quantities, double factor_sigma);

}  // namespace slammot::matching
