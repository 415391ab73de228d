#include "services/localization/slip_match.hpp"

#include <array>

#include "services/localization/step_likelihoods.hpp"

namespace slammot::localization {
namespace {

/// Log-likelihood of the scan under a hypothesis [nats], up to a constant of the scan. Beside a
/// pose that is off, the points that tell so do not match any more: their share tells it.
double log_likelihood_under_slip(const StepToExplain& scan, const Step& step,
                                 const matching::PointToLineResult& registered,
                                 const LocalizerConfig& config) {
  constexpr double kIndependentPoints = 0.1;  // share of a scan's: the scans of a second meet the
                                              // same surfaces
  const geometry::Pose2 optimum = sensing::scan_optimum(step.prior(), registered.map_from_base.pose,
                                                        registered.scan_information);
  const double fit = matching::fit_of(registered, config.match.robust_scale_m);
  return log_likelihood_of(step, optimum, registered) +
         config.belief.share_nats * scan.points.evidence_share() * kIndependentPoints *
             (fit + registered.matched_share);
}

}  // namespace

ExplainedStep explain_slip(const StepToExplain& scan, const LocalizerConfig& config,
                           ScanMatcher& matcher) {
  std::array<matching::PointToLineResult, sensing::WheelSlip::kMost> registered;
  sensing::WheelSlip slip = scan.steps.front().slip;
  for (std::size_t i = 0; i < scan.steps.size(); ++i) {
    const Step& step = scan.steps[i];
    scan.take_points(step);
    registered[i] = matcher.register_from(step.after.odom_from_base, step.prior(),
                                          {scan.points.matched(), scan.map.surfels(), step});
    slip[i].log_weight += log_likelihood_under_slip(scan, step, registered[i], config);
    if (registered[i].matched_share >= config.trust.least_matched_share)
      slip[i] = sensing::matched(slip[i], registered[i].map_from_base);
  }
  const std::size_t best = slip.likeliest();
  ExplainedStep explained{.step = scan.steps[best],
                          .registered = registered[best],
                          .weights = sensing::ExplanationWeights{1.0, 0.0, 0.0, 0.0},
                          .searches = 0};
  explained.step.slip = slip.decided();
  scan.take_points(explained.step);
  return explained;
}

}  // namespace slammot::localization
