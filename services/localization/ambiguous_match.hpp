#pragma once

#include <cstdint>
#include <vector>

#include "common/matching/scrim.hpp"

namespace slammot::localization {

struct AmbiguousMatchConfig {
  double weak_share = 0.001;  ///< A scan that says less than this share of the most about some
                              ///< direction is sampled; 0: none is.
  matching::ScrimConfig scrim{.samples = 12, .cell_size_m = 0.4};  ///< Enough for a covariance:
                                                                   ///< docs/results.md.
};

/// Whether the scan leaves some direction of the position to the prediction: the share of
/// information that the noise of a wall's normals alone gives is the square of their error, 1e-4;
/// in streets and buildings there is never less than 2e-3. scan_information: 3x3 over (x [m], y
/// [m], heading [rad]), of the points alone.
bool says_little(const geometry::Matrix3& scan_information, const AmbiguousMatchConfig& config);

/// What a match starts from, and what the closed form made of it.
struct MatchToSample {
  const std::vector<matching::MatchPoint>& points;
  const grids::SurfelMap& surfels;
  geometry::UncertainPose2 prior_odom_from_base;
  matching::PointToLineResult closed_form;
};

/// Matches anew by SCRIM where the closed form cannot be believed: along a featureless wall the
/// small errors of its normals look like information, and scan after scan they add up to a
/// certainty that nothing has observed. Guesses are spread wider than such errors reach; what the
/// refined ones have in common, and no more than the closed form says, was observed, and is fused
/// with the prediction. Where they fall into several clusters the pose is that of the cluster
/// nearest to the prediction, and the covariance covers them all. Data-driven: Wang 2004,
/// sections 3.3 and 6.4.
class AmbiguousMatcher {
 public:
  /// The same for the same seed.
  geometry::UncertainPose2 match(const MatchToSample& match, const AmbiguousMatchConfig& config,
                                 const matching::PointToLineConfig& match_config,
                                 std::uint64_t seed);

 private:
  matching::Scrim scrim_;
};

}  // namespace slammot::localization
