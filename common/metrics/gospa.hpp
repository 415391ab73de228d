#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace slammot::metrics {

/// Generalized optimal sub-pattern assignment of one scan: Rahmathullah et al. 2017, with alpha = 2
/// and p = 2. distance^2 = localization + missed + false_tracks, all in m^2.
struct Gospa {
  double distance_m = 0.0;
  double localization_m2 = 0.0;
  double missed_m2 = 0.0;
  double false_tracks_m2 = 0.0;
};

/// Distances in metres, row an object, column a track; distances beyond the cutoff are no pairs. A
/// missed object and a false track each cost half of the squared cutoff.
Gospa gospa(const Eigen::MatrixXd& distance_m, double cutoff_m);

}  // namespace slammot::metrics
