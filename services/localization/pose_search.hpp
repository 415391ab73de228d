#pragma once

#include <vector>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/grids/surfel_map.hpp"
#include "common/matching/correlative.hpp"
#include "common/matching/point_to_line.hpp"
#include "services/localization/localizer_config.hpp"

namespace slammot::localization {

/// Whether a prediction is too unsure for a match to begin at it.
bool is_vague(const geometry::UncertainPose2& prior, const LocalizerConfig& config);

/// Searches the local map for poses at which the points of a scan lie on it, by correlation.
class PoseSearch {
 public:
  /// search: how many peaks are told apart, and how fine; in place of the configuration's own.
  PoseSearch(const LocalizerConfig& config, const matching::CorrelativeConfig& search);

  /// Best first, within search_sigmas of the prior; empty where nothing scores.
  std::vector<matching::Peak> peaks_around(const geometry::UncertainPose2& prior, const std::vector<matching::MatchPoint>& points, const grids::SurfelMap& surfels);

 private:
  matching::SearchWindow window_about(const geometry::UncertainPose2& prior) const;

  LocalizerConfig config_;
  matching::CorrelativeMatcher matcher_;
};

}  // namespace slammot::localization
