#pragma once

#include <cstdint>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/correlative.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/work/side_work.hpp"
#include "services/localization/ambiguous_match.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/pose_search.hpp"
#include "services/localization/scan_match.hpp"

namespace slammot::localization {

/// What a scan is matched by and against.
struct ScanToMatch {
  const std::vector<matching::MatchPoint>& points;
  const grids::SurfelMap& surfels;  ///< In odom.
  const Step& step;                 ///< Its prediction is the prior.
  std::uint32_t sequence = 0;       ///< Of the scan: seed of what is sampled.
  const matching::PointToLineResult* registered = nullptr;  ///< Where the points were registered
                                                            ///< under this prediction already.
};

/// Matches scans against the local map: point-to-line registration from the prediction, from the
/// best answer of a search where the prediction is vague, and by sampling along directions of which
/// the scan says too little.
class ScanMatcher {
 public:
  /// With fewer the prediction is the pose.
  static constexpr std::size_t kFewestEchoes = 10;

  /// help (null: none) must outlive this; the results are the same with it and without.
  explicit ScanMatcher(const LocalizerConfig& config, work::SideWork* help = nullptr);

  /// The prediction where there are too few points (neither believed nor lost) or too few of them
  /// match (lost).
  ScanMatch match(const ScanToMatch& scan);

  /// Whether there are enough points for a match.
  bool can_match(const std::vector<matching::MatchPoint>& points) const {
    return points.size() >= kFewestEchoes;
  }

  /// Share of a scan's information that counts under this prediction: points of scans shortly after
  /// each other share the map's error.
  double information_share(const Step& step) const { return config_for(step).information_share; }

  /// Registers from a pose other than the prediction, with this prior. No judgement of the result.
  matching::PointToLineResult register_from(const geometry::Pose2& odom_from_base,
                                            const geometry::UncertainPose2& prior,
                                            const ScanToMatch& scan);

 private:
  matching::PointToLineConfig config_for(const Step& step) const;
  matching::PointToLineConfig beside_wheels(const Step& step) const;
  geometry::Pose2 found_in(const matching::SearchWindow& window, const geometry::Pose2& middle,
                           const ScanToMatch& scan);
  geometry::Pose2 found_around(const geometry::UncertainPose2& prior, const ScanToMatch& scan);
  matching::PointToLineResult match_from_search(const ScanToMatch& scan);

  LocalizerConfig config_;
  matching::PointToLineConfig without_wheels_;  ///< For a step of which wheels say nothing: nothing
                                                ///< but the scan tells of it.
  matching::PointToLineConfig by_scans_alone_;  ///< Where there are no wheels at all.
  matching::CorrelativeMatcher search_;  ///< Exact: without odometry the first steps have nothing
                                         ///< else.
  PoseSearch search_far_;                ///< Bounded: windows in which the other takes a second.
  matching::PointToLineMatcher matcher_;
  AmbiguousMatcher ambiguous_matcher_;
};

}  // namespace slammot::localization
