#pragma once

#include <cstdint>
#include <optional>

#include "common/matching/point_to_line.hpp"
#include "common/sensing/odometry_belief.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/pose_search.hpp"
#include "services/localization/scan_matcher.hpp"
#include "services/localization/scan_overlap.hpp"
#include "services/localization/step_likelihoods.hpp"
#include "services/localization/step_to_explain.hpp"

namespace slammot::localization {

struct ExplainedStep {
  Step step;                               ///< The most likely explanation,
  matching::PointToLineResult registered;  ///< and the registration under it.
  sensing::ExplanationWeights weights;     ///< After the scan.
  std::uint64_t searches = 0;
};

/// Finds the pose of a scan under a mixture of predictions: maximises likelihood of the scan times
/// prior over explanations and poses. Where odometry is sure and the scan does not contradict it,
/// that is one registration; else the map is searched as far as the explanations reach.
class MixtureMatch {
 public:
  explicit MixtureMatch(const LocalizerConfig& config);

  ExplainedStep explain(const StepToExplain& scan, ScanMatcher& matcher);

 private:
  ExplainedStep explain_as_weighed(const StepToExplain& scan, ScanMatcher& matcher);
  ExplainedStep explain_without_odometry(const StepToExplain& scan, ScanMatcher& matcher);

  /// The best of what was found so far.
  struct Best {
    std::size_t step = 0;  ///< Index into StepToExplain::steps.
    matching::PointToLineResult registered;
    double contradicted_share = 0.0;  ///< Of its points, by the map.
    double log_posterior = 0.0;
    LogLikelihoods log_likelihoods{};  ///< Of each explanation at its best pose.
  };

  Best at_prediction(const StepToExplain& scan, ScanMatcher& matcher) const;
  static Best nothing_yet();
  void around(const StepToExplain& scan, std::size_t explanation, ScanMatcher& matcher, Best& best);
  ExplainedStep concluded(const StepToExplain& scan, const Best& best,
                          const sensing::ExplanationWeights& weights, ScanMatcher& matcher) const;
  double before_on_scan(const StepToExplain& scan, const matching::PointToLineResult& registered);
  bool backs_away(const StepToExplain& scan, ScanMatcher& matcher);
  void compare(const StepToExplain& scan, std::size_t wide, const geometry::Pose2& start,
               ScanMatcher& matcher, Best& best);
  std::vector<geometry::Pose2> poses_around(const StepToExplain& scan,
                                            const geometry::UncertainPose2& prior,
                                            PoseSearch& search) const;

  LocalizerConfig config_;
  PoseSearch search_;
  PoseSearch search_anywhere_;
  std::uint64_t searches_ = 0;
  std::optional<bool> backs_away_;  ///< Of the scan at hand; none: not judged yet.
  ScanOverlap overlap_;
};

}  // namespace slammot::localization
