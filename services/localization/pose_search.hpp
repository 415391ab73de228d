#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/matching/wide_search.hpp"
#include "services/localization/localizer_config.hpp"

namespace slammot::localization {

/// Whether a prediction is too unsure for a match to begin at it.
bool is_vague(const geometry::UncertainPose2& prior, const LocalizerConfig& config);

/// Window of search_sigmas around the prior, no farther than search_reach_m.
matching::SearchWindow search_window(const geometry::UncertainPose2& prior,
                                     const LocalizerConfig& config);

/// Searches the local map for poses at which the points of a scan lie on it: correlation by branch
/// and bound, coarser the wider the window is, with a bound on the work that is counted and not
/// timed.
class PoseSearch {
 public:
  /// max_peaks: how many poses are told apart at most.
  PoseSearch(const LocalizerConfig& config, std::size_t max_peaks);

  /// True for windows so large that the work of their search is bounded by larger cells.
  bool is_coarse_in(const matching::SearchWindow& window) const;

  /// Poses in odom, best first, within search_sigmas of the prior; empty where nothing scores. The
  /// surfels in reach are taken anew.
  std::vector<geometry::Pose2> poses_around(const geometry::UncertainPose2& prior,
                                            const std::vector<matching::MatchPoint>& points,
                                            const grids::SurfelMap& surfels);

 private:
  double finest_cell_m() const;
  double cell_m_for(const matching::SearchWindow& window) const;
  std::vector<Eigen::Vector2f> thinned(const std::vector<matching::MatchPoint>& points) const;
  std::vector<matching::TargetPoint> targets_about(const geometry::Vector2& centre_m,
                                                   const grids::SurfelMap& surfels) const;

  LocalizerConfig config_;
  std::size_t max_peaks_;
};

}  // namespace slammot::localization
