#include "services/localization/step_likelihoods.hpp"

#include <limits>

namespace slammot::localization {
namespace {

using sensing::StepExplanation;

/// Odometry that reports a change of velocity which no vehicle makes is wrong, whatever the scan
/// says.
double dynamics(const Step& step, const Step& by_velocity) {
  if (by_velocity.source != StepSource::kVelocityAlone ||
      step.explanation == StepExplanation::kOther)
    return 0.0;
  return sensing::log_likelihood_of_acceleration(step.before_from_base,
                                                 by_velocity.before_from_base, step.duration_s);
}

}  // namespace

double log_likelihood_of(const Step& step, const geometry::Pose2& optimum,
                         const matching::PointToLineResult& registered) {
  return sensing::log_marginal_likelihood(step.prior(), optimum, registered.scan_information);
}

LogLikelihoods log_priors(const StepToExplain& scan, const geometry::Pose2& optimum,
                          const matching::PointToLineResult& registered) {
  LogLikelihoods logs;
  logs.fill(-std::numeric_limits<double>::infinity());
  const Step& first = scan.steps.front();
  if (first.source == StepSource::kReach) {
    logs[sensing::index_of(StepExplanation::kOther)] = scan.history.log_marginal(
        first.odom_from_base_before, first.prior(), optimum, registered.scan_information);
    return logs;
  }
  const Step& by_velocity = scan.steps[widest(scan, kOtherStep)];
  for (const Step& step : scan.steps)
    logs[sensing::index_of(step.explanation)] =
        log_likelihood_of(step, optimum, registered) + dynamics(step, by_velocity);
  return logs;
}

std::size_t likeliest_step(const StepToExplain& scan, std::size_t explanation,
                           const geometry::Pose2& optimum,
                           const matching::PointToLineResult& registered) {
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scan.steps.size(); ++i) {
    if (sensing::index_of(scan.steps[i].explanation) != explanation) continue;
    const double log_likelihood = log_likelihood_of(scan.steps[i], optimum, registered);
    if (log_likelihood <= most) continue;
    most = log_likelihood;
    best = i;
  }
  return best;
}

}  // namespace slammot::localization
