#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "common/matching/scrim.hpp"

namespace slammot::matching {

struct SaliencyConfig {
  double position_sigma_m = 0.5;   ///< One sigma of the displacement before self-registration.
  double heading_sigma_rad = 0.1;  ///< One sigma of the rotation about the object's middle.
  double surfel_size_m = 0.2;
  std::size_t most_points = 0;  ///< Registered with all of them, taken evenly; 0: all.
  ScrimConfig scrim;
  PointToLineConfig match;
};

/// Object saliency score: 1 / trace of the covariance [m^2, rad^2] with which the object is
/// registered with itself; Wang 2004, Eqs. (3.10)-(3.11). The larger, the surer a pose from this
/// shape; 1 / trace of the displacements' covariance for a shape that tells nothing, 0 for no
/// points. Does not depend on where the points' frame is. Finished submaps carry theirs
/// (services/localization/submap_saliency.hpp); nothing decides by it. The measure that the thesis
/// orders objects by; whether a scan is to be sampled the product tells from the closed form's
/// information, which it has without registering anything
/// (services/localization/ambiguous_match.hpp).
double saliency_score(const std::vector<MatchPoint>& points, const SaliencyConfig& config,
                      std::mt19937_64& random);

/// The same of an object that is not the same each time it is seen, such as foliage: what was seen
/// again is registered with the first view, both in one frame.
double saliency_score(const std::vector<MatchPoint>& points,
                      const std::vector<MatchPoint>& seen_again, const SaliencyConfig& config,
                      std::mt19937_64& random);

}  // namespace slammot::matching
