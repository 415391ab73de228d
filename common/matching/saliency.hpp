#pragma once

#include <random>
#include <vector>

#include "common/matching/scrim.hpp"

namespace slammot::matching {

struct SaliencyConfig {
  double position_sigma_m = 0.5;   ///< One sigma of the displacement before self-registration.
  double heading_sigma_rad = 0.1;  ///< One sigma of the rotation about the object's middle.
  double surfel_size_m = 0.2;
  ScrimConfig scrim;
  PointToLineConfig match;
};

/// Object saliency score: 1 / trace of the covariance [m^2, rad^2] with which the object is
/// registered with itself; Wang 2004, Eqs. (3.10)-(3.11). The larger, the surer a pose from this
/// shape; 1 / trace of the displacements' covariance for a shape that tells nothing, 0 for no
/// points. Does not depend on where the points' frame is. The measure that the thesis orders
/// objects by; whether a scan is to be sampled the product tells from the closed form's
/// information, which it has without registering anything
/// (services/localization/ambiguous_match.hpp).
double saliency_score(const std::vector<MatchPoint>& points, const SaliencyConfig& config,
                      std::mt19937_64& random);

}  // namespace slammot::matching
