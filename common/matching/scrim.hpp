#pragma once

#include <random>
#include <vector>

#include "common/matching/occupancy_patch.hpp"
#include "common/matching/point_to_line.hpp"

namespace slammot::matching {

struct ScrimConfig {
  int samples = 32;           ///< Number of initial guesses, at least 8; antithetic pairs.
  double cell_size_m = 0.2;   ///< Of the correlation grids.
  double least_share = 0.8;   ///< Samples below this share of the best correlation are ignored.
  double valley_share = 0.9;  ///< Two neighbours are in different clusters if the correlation
                              ///< between them is below this share of both.
};

/// One Gaussian of the pose's mixture.
struct PoseCluster {
  geometry::UncertainPose2 map_from_base;
  double weight = 0.0;  ///< Weights of all clusters sum to 1.
};

struct ScrimResult {
  geometry::UncertainPose2 map_from_base;  ///< All samples as one Gaussian.
  std::vector<PoseCluster> clusters;       ///< Heaviest first; one if the pose is not ambiguous.
  double matched_share = 0.0;              ///< Share of matched points, mean over the samples.
};

/// Sampling- and correlation-based range image matching; Wang 2004, section 3.3. PointToLineMatcher
/// refines each of N initial guesses drawn from the prior, with the guess as the prior's mean.
/// Samples are weighted by the correlation of grids that include the measurement noise, and are
/// grouped into clusters. Additions to the thesis: guesses are antithetic pairs with exactly the
/// prior's covariance. Each refined sample keeps the covariance that is due to the measurement
/// noise, which a spread of guesses cannot show (law of total covariance; randomized maximum
/// likelihood, Oliver, He and Reynolds 1996). If correspondences do not depend on the guess, the
/// covariance equals that of the closed form. The fewer guesses a cluster has, the less weight
/// their spread gets.
class Scrim {
 public:
  /// Returns the posterior under the prior. Returns the prior as the only cluster if no sample
  /// matches.
  ScrimResult match(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                    const geometry::UncertainPose2& prior_map_from_base, const ScrimConfig& config,
                    const PointToLineConfig& match_config, std::mt19937_64& random);

 private:
  struct Sample {
    geometry::Pose2 map_from_base;
    geometry::Matrix3 by_noise;  ///< Covariance due to the measurement noise.
    geometry::Matrix3 by_guess;  ///< Covariance due to the spread of guesses, to first order.
    double correlation = 0.0;
    int cluster = 0;
  };
  class Moments;

  double correlation_at(const geometry::Pose2& map_from_base) const;
  int gather(double valley_share);

  PointToLineMatcher matcher_;
  OccupancyPatch map_patch_;
  std::vector<OccupiedCell> scan_cells_;
  std::vector<Sample> samples_;
};

}  // namespace slammot::matching
