#pragma once

#include <random>
#include <vector>

#include "common/matching/occupancy_patch.hpp"
#include "common/matching/point_to_line.hpp"

namespace slammot::matching {

struct ScrimConfig {
  int samples = 32;                ///< Initial guesses, at least 8; they come in pairs.
  double cell_size_m = 0.2;        ///< Of the grids that are correlated.
  double least_share = 0.8;        ///< Samples with less than this share of the best correlation do not count.
  double valley_share = 0.9;       ///< Two neighbours are of different clusters where the correlation between them is below this share of both.
};

/// Where the pose may be, as one of several Gaussians.
struct PoseCluster {
  geometry::UncertainPose2 map_from_base;
  double weight = 0.0;             ///< Of all clusters together 1.
};

struct ScrimResult {
  geometry::UncertainPose2 map_from_base;   ///< All samples as one Gaussian.
  std::vector<PoseCluster> clusters;        ///< Heaviest first; one where the answer is not ambiguous.
  double matched_share = 0.0;               ///< Of the points, in the mean over the samples.
};

/// Sampling and correlation based range image matching; Wang 2004, section 3.3. Each of N initial guesses, drawn from the
/// prior, is refined by PointToLineMatcher with itself as the mean of the prior; the samples are weighted with the
/// correlation of grids that carry the measurement noise, and are gathered into clusters.
/// What is added to the thesis: where correspondences do not change with the guess the covariance is exactly that of
/// the closed form. The guesses lie in opposite pairs and have the prior's covariance exactly, and each refined one keeps
/// the share of the covariance that no spread of guesses can show, that of the measurement noise (law of total covariance;
/// randomized maximum likelihood, Oliver, He and Reynolds 1996). The fewer guesses a Gaussian is made of, the less their
/// spread is believed.
class Scrim {
 public:
  /// Posterior under the prior. The prior itself, as the only cluster, when no sample lies on anything.
  ScrimResult match(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                    const geometry::UncertainPose2& prior_map_from_base, const ScrimConfig& config,
                    const PointToLineConfig& match_config, std::mt19937_64& random);

 private:
  struct Sample {
    geometry::Pose2 map_from_base;
    geometry::Matrix3 by_noise;              ///< Covariance that the measurement noise gives it,
    geometry::Matrix3 by_guess;              ///< and the one that the spread of guesses does, to first order.
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
