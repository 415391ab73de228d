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

/// Object saliency score: 1 / trace of the covariance [m^2, rad^2] of the object's registration with itself; Wang 2004,
/// Eqs. (3.10)-(3.11). The larger, the better the shape determines a pose. An uninformative shape scores 1 / trace of
/// the displacements' covariance; no points score 0. The score does not depend on the points' frame. It reproduces the
/// thesis' ordering of objects. The product decides on sampling by the closed form's information instead, which needs
/// no registration (services/localization/ambiguous_match.hpp).
double saliency_score(const std::vector<MatchPoint>& points, const SaliencyConfig& config, std::mt19937_64& random);

}  // namespace slammot::matching
