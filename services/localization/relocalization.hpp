#pragma once

#include <optional>

#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/pose_search.hpp"
#include "services/localization/scan_match.hpp"
#include "services/localization/scan_matcher.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// What a search for a lost vehicle has done.
struct RelocalizationResult {
  bool has_searched = false;
  std::optional<ScanMatch> found;
};

/// Searches the local map for a vehicle that is lost: all headings, and the wider the longer it is
/// lost. An answer counts where found_share of the points match, little contradicts the map and no
/// other place is about as good.
class Relocalization {
 public:
  explicit Relocalization(const LocalizerConfig& config);

  /// lost_scans: since when it is lost; most scans are not worth a search. The matcher registers
  /// what the search finds.
  RelocalizationResult find(int lost_scans, const Step& step, const ScanPoints& points,
                            const LocalMap& map, ScanMatcher& matcher);

 private:
  struct Candidate {
    ScanMatch match;
    double quality = 0.0;  ///< In [0, 1]; 0 where it does not count.
  };

  geometry::UncertainPose2 anywhere_about(const geometry::UncertainPose2& prior,
                                          int lost_scans) const;
  Candidate registered(const geometry::Pose2& about, const geometry::Matrix3& covariance,
                       const ScanPoints& points, const LocalMap& map, const ScanToMatch& scan,
                       ScanMatcher& matcher) const;

  LocalizerConfig config_;
  PoseSearch search_;
};

}  // namespace slammot::localization
