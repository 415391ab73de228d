#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/sensing/odometry_belief.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/pose_search.hpp"
#include "services/localization/scan_matcher.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// A scan, and the mixture of predictions of its pose.
struct StepToExplain {
  StepMixture steps;  ///< One an explanation; odometry as calibrated first, then its heavy tail,
                      ///< then the rest.
  sensing::ExplanationWeights weights;  ///< Before the scan.
  double usual_share = 0.5;             ///< Of points that match.
  const sensing::StepHistory& history;  ///< Of the drive: the prior without odometry.
  const ScanPoints& points;             ///< Under the prediction taken last.
  const LocalMap& map;
  std::function<void(const Step&)> take_points;  ///< Takes the points under another prediction.
};

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
  using LogLikelihoods = std::array<double, sensing::kStepExplanations>;

  /// The best of what was found so far.
  struct Best {
    std::size_t step = 0;  ///< Index into StepToExplain::steps.
    matching::PointToLineResult registered;
    double contradicted_share = 0.0;  ///< Of its points, by the map.
    double log_posterior = 0.0;
    LogLikelihoods log_likelihoods{};  ///< Of each explanation at its best pose.
  };

  static LogLikelihoods log_priors(const StepToExplain& scan, const geometry::Pose2& optimum,
                                   const matching::PointToLineResult& registered);
  static std::size_t likeliest_step(const StepToExplain& scan, std::size_t explanation,
                                    const geometry::Pose2& optimum,
                                    const matching::PointToLineResult& registered);
  Best at_prediction(const StepToExplain& scan, ScanMatcher& matcher) const;
  static Best nothing_yet();
  void around(const StepToExplain& scan, std::size_t explanation, ScanMatcher& matcher, Best& best);
  ExplainedStep concluded(const StepToExplain& scan, const Best& best,
                          const sensing::ExplanationWeights& weights, ScanMatcher& matcher) const;
  void map_points(const ScanPoints& points);
  /// In [0, 1].
  struct Overlap {
    double on_map = 0.0;          ///< Share of the scan that lies on the map,
    double before_on_scan = 0.0;  ///< and of the scan before that lies on this one.
  };
  Overlap overlap(const StepToExplain& scan, const matching::PointToLineResult& registered);
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
  matching::PointToLineConfig config_of_scans_;
  grids::SurfelMap surfels_;  ///< Of the scan, in its base.
  matching::PointToLineMatcher match_scans_;
};

}  // namespace slammot::localization
