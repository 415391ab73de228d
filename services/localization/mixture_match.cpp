#include "services/localization/mixture_match.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/localization/map_agreement.hpp"

namespace slammot::localization {
namespace {

using sensing::StepExplanation;

constexpr double kSuspiciousBelow = 0.9;       // Below this probability of sound odometry every
                                               // explanation is matched for itself.
constexpr double kSuspiciousShareDrop = 0.15;  // So it is where the matched share falls below
                                               // its usual value by more than this.

constexpr double kLeastOfUsualShare = 0.6;  // of the usual matched share: with less, an explanation
                                            // other than odometry does not win

constexpr std::size_t kWheels = 0;  // places of the explanations that set the window of a search
constexpr std::size_t kRough = 1;
constexpr std::size_t kOther = kOtherStep;
constexpr double kStands_s = 1.0;          // without motion by odometry: passers-by move the scan
constexpr double kIndependentShare = 0.4;  // of the points: neighbours share a surface's errors

constexpr double kUsualDrop = 0.07;         // of the matched share, from scan to scan
constexpr std::size_t kLikelySteps = 2;     // the last ones of a mixture without odometry: like the
                                            // last step, and straight on
constexpr std::size_t kPoses = 4;           // that a search tells apart,
constexpr std::size_t kPosesAnywhere = 12;  // and where any step is looked for: the search counts
                                            // points on surfels, so that poses into a known room
                                            // come before the one that looks into an unseen one
constexpr double kClearlyMore = 0.1;        // of the points
constexpr double kBacks_m = 0.1;            // way out of the view
constexpr std::size_t kStepsToKnow = 10;    // before it is known how well scans usually fit

/// Share of a scan's points that say on their own whether they match: those of scans shortly after
/// each other meet the same moving things.
double independent_share(const Step& step) {
  constexpr double kFrequent_s = 0.2;
  constexpr double kRare_s = 0.5;
  return kIndependentShare *
         (1.0 +
          std::clamp((step.usual_duration_s - kFrequent_s) / (kRare_s - kFrequent_s), 0.0, 1.0));
}

/// Without odometry nothing tells of a pose but the scan and the usual steps, of which a look-alike
/// place is often one. Half a nat a point, which is careful beside odometry, lets a place where a
/// usual step ends outweigh a twentieth of the points: docs/decisions/scan-matching.md.
double weight_of_evidence(const Step& step) {
  constexpr double kWithoutOdometry = 2.5;
  const bool is_without = step.source == StepSource::kReach && !step.wheels.wheel_from_base;
  return is_without ? kWithoutOdometry : 1.0;
}

/// What is asked more of another motion than to be likelier than wheels in doubt [nats], where the
/// place is not known: bare walls tell of neither, and traffic that moves along says "it stands".
double asked_more(const Step& by_wheels, std::size_t explanation) {
  constexpr double kClearlyLikelier = 2.2;
  constexpr double kUnknown_m = 0.07;
  const bool is_other = explanation == sensing::index_of(StepExplanation::kOther);
  const auto& before = by_wheels.odom_from_base_before.covariance;
  const bool is_unknown = before(0, 0) + before(1, 1) > kUnknown_m * kUnknown_m;
  return is_other && is_unknown && by_wheels.wheels.are_in_doubt ? kClearlyLikelier : 0.0;
}

/// Way of the laser towards the middle of what it sees.
double moved_into_view_m(const ScanPoints& points, const geometry::Pose2& before_from_now) {
  const geometry::Vector2& laser_m = points.laser_in_base_m();
  geometry::Vector2 sum_m = geometry::Vector2::Zero();
  for (const matching::MatchPoint& point : points.matched()) sum_m += point.in_base_m - laser_m;
  const geometry::Vector2 moved_m = laser_m - geometry::inverse(before_from_now) * laser_m;
  return sum_m.isZero() ? 0.0 : moved_m.dot(sum_m.normalized());
}

}  // namespace

/// What one scan says against explanations that differ now does not share the errors of the scans
/// before: all of the map counts, as it does where scans are rare.
Step by_scan_alone(Step step) {
  if (step.usual_duration_s < sensing::kRareScans_s) step.source = StepSource::kVelocityThisOnce;
  return step;
}

MixtureMatch::MixtureMatch(const LocalizerConfig& config)
    : config_(config),
      search_(config, kPoses),
      search_anywhere_(config, kPosesAnywhere),
      overlap_(config) {}

/// Every explanation at the pose that odometry leads to: what a pose close by would say of them
/// differs little.
MixtureMatch::Best MixtureMatch::at_prediction(const StepToExplain& scan,
                                               ScanMatcher& matcher) const {
  const Step& by_wheels = scan.steps.front();
  const geometry::UncertainPose2 prior = by_wheels.prior();
  Best best{.step = 0,
            .registered = matcher.register_from(
                prior.pose, prior, {scan.points.matched(), scan.map.surfels(), by_wheels})};
  best.log_likelihoods.fill(-std::numeric_limits<double>::infinity());
  const geometry::Pose2 optimum = sensing::scan_optimum(prior, best.registered.map_from_base.pose,
                                                        best.registered.scan_information);
  for (const Step& step : scan.steps)
    best.log_likelihoods[sensing::index_of(step.explanation)] =
        log_likelihood_of(step, optimum, best.registered);
  return best;
}

double MixtureMatch::before_on_scan(const StepToExplain& scan,
                                    const matching::PointToLineResult& registered) {
  return overlap_.before_on_scan(scan.points, geometry::inverse(registered.map_from_base.pose) *
                                                  scan.steps.front().odom_from_base_before.pose);
}

/// A scanner that moves away from what it sees has half of its echoes where the map has none yet:
/// in a corridor the map alone says that the vehicle stands. What it saw before it sees again. Of
/// scans shortly after each other the map tells enough, and traffic moves along with both.
bool MixtureMatch::backs_away(const StepToExplain& scan, ScanMatcher& matcher) {
  const Step& first = scan.steps.front();
  if (first.usual_duration_s < sensing::kRareScans_s) return false;
  const Step& likely =
      first.source == StepSource::kReach ? scan.steps[scan.steps.size() - kLikelySteps] : first;
  scan.take_points(likely);
  const geometry::UncertainPose2 prior = likely.prior();
  const geometry::Pose2 before_from_now =
      geometry::inverse(first.odom_from_base_before.pose) * prior.pose;
  if (moved_into_view_m(scan.points, before_from_now) > -kBacks_m) return false;
  overlap_.map_points(scan.points);
  const matching::PointToLineResult registered =
      matcher.register_from(prior.pose, prior, {scan.points.matched(), scan.map.surfels(), likely});
  return before_on_scan(scan, registered) >
         matching::fit_of(registered, config_.match.robust_scale_m) + kClearlyMore;
}

/// Registers from one pose under a wide prediction, and compares every explanation there with the
/// best so far.
void MixtureMatch::compare(const StepToExplain& scan, std::size_t wide,
                           const geometry::Pose2& start, ScanMatcher& matcher, Best& best) {
  const Step& prediction = scan.steps[wide];
  const Step evidence = by_scan_alone(scan.steps.front());
  matching::PointToLineResult registered = matcher.register_from(
      start, prediction.prior(), {scan.points.matched(), scan.map.surfels(), evidence});
  registered.scan_information *= kIndependentShare;
  const geometry::Pose2& pose = registered.map_from_base.pose;
  const geometry::Pose2 optimum =
      sensing::scan_optimum(prediction.prior(), pose, registered.scan_information);
  const double contradicted_share =
      agreement(scan.points, pose, scan.map.evidence(), config_.map).contradicting_share();
  double fits_share = matching::fit_of(registered, config_.match.robust_scale_m);
  if (*backs_away_) fits_share = std::max(fits_share, before_on_scan(scan, registered));
  fits_share -= contradicted_share;
  const double fit = config_.belief.share_nats * scan.points.evidence_share() *
                     independent_share(scan.steps.front()) *
                     weight_of_evidence(scan.steps.front()) * fits_share;
  const LogLikelihoods priors = log_priors(scan, optimum, registered);
  for (std::size_t explanation = 0; explanation < priors.size(); ++explanation) {
    const double log_likelihood = fit + priors[explanation];
    best.log_likelihoods[explanation] = std::max(best.log_likelihoods[explanation], log_likelihood);
    const double log_posterior = log_likelihood + std::log(scan.weights[explanation]) -
                                 asked_more(scan.steps.front(), explanation);
    if (log_posterior <= best.log_posterior) continue;
    best.step = likeliest_step(scan, explanation, optimum, registered);
    best.registered = registered;
    best.contradicted_share = contradicted_share;
    best.log_posterior = log_posterior;
  }
}

/// Where the vehicle backs away from what it sees, the scan before is looked for on this one, too.
std::vector<geometry::Pose2> MixtureMatch::poses_around(const StepToExplain& scan,
                                                        const geometry::UncertainPose2& prior,
                                                        PoseSearch& search) const {
  std::vector<geometry::Pose2> poses =
      search.poses_around(prior, scan.points.matched(), scan.map.surfels());
  if (!*backs_away_) return poses;
  const geometry::Pose2& before = scan.steps.front().odom_from_base_before.pose;
  for (const geometry::Pose2& now_from_before :
       search.poses_around({geometry::inverse(prior.pose) * before, prior.covariance},
                           scan.points.matched_before(), overlap_.surfels()))
    poses.push_back(before * geometry::inverse(now_from_before));
  return poses;
}

MixtureMatch::Best MixtureMatch::nothing_yet() {
  Best best;
  best.log_posterior = -std::numeric_limits<double>::infinity();
  best.log_likelihoods.fill(-std::numeric_limits<double>::infinity());
  return best;
}

void MixtureMatch::around(const StepToExplain& scan, std::size_t explanation, ScanMatcher& matcher,
                          Best& best) {
  if (!backs_away_) backs_away_ = backs_away(scan, matcher);
  const Step& prediction = scan.steps[explanation];
  scan.take_points(prediction);
  if (*backs_away_) overlap_.map_points(scan.points);
  const geometry::UncertainPose2 prior = prediction.prior();
  compare(scan, explanation, prior.pose, matcher, best);
  if (!is_vague(prior, config_)) return;
  ++searches_;
  const bool is_anywhere = explanation == kWheels && prediction.source == StepSource::kReach;
  PoseSearch& search = is_anywhere ? search_anywhere_ : search_;
  for (const geometry::Pose2& pose : poses_around(scan, prior, search))
    compare(scan, explanation, pose, matcher, best);
}

/// Wheels that change their velocity as no vehicle does are as likely wrong as right.
sensing::ExplanationWeights in_doubt(sensing::ExplanationWeights weights) {
  double& wheels = weights[sensing::index_of(StepExplanation::kWheels)];
  double& other = weights[sensing::index_of(StepExplanation::kOther)];
  const double both = wheels + other;
  other = std::max(other, 0.5 * both);
  wheels = both - other;
  return weights;
}

ExplainedStep MixtureMatch::explain(const StepToExplain& questioned, ScanMatcher& matcher) {
  if (!questioned.steps.front().wheels.are_in_doubt) return explain_as_weighed(questioned, matcher);
  StepToExplain scan = questioned;
  scan.weights = in_doubt(scan.weights);
  return explain_as_weighed(scan, matcher);
}

ExplainedStep MixtureMatch::explain_as_weighed(const StepToExplain& scan, ScanMatcher& matcher) {
  searches_ = 0;
  backs_away_.reset();
  const Step& by_wheels = scan.steps.front();
  if (by_wheels.source == StepSource::kReach) return explain_without_odometry(scan, matcher);
  const bool is_unsure =
      is_vague(by_wheels.prior(), config_) && !by_wheels.last_was_sampled;  // along a bare wall a
                                                                            // search finds any
                                                                            // place as good as any
                                                                            // other
  Best best = is_unsure ? nothing_yet() : at_prediction(scan, matcher);
  if (is_unsure) around(scan, widest(scan, kRough), matcher, best);
  sensing::ExplanationWeights weights = sensing::updated(scan.weights, best.log_likelihoods);
  const bool stands = by_wheels.wheels.stood_s > kStands_s && !by_wheels.wheels.are_in_doubt;
  const bool has_changed = !is_unsure && by_wheels.wheels.are_in_doubt;
  const bool is_suspicious =
      has_changed ||
      (!is_unsure && weights[sensing::index_of(StepExplanation::kWheels)] < kSuspiciousBelow);
  const bool fits_less = best.registered.matched_share < scan.usual_share - kSuspiciousShareDrop;
  if (!is_unsure && (stands || (!is_suspicious && !fits_less)))
    return {scan.steps.front(), best.registered, weights, 0};
  if (scan.steps.size() > 1 && (is_suspicious || fits_less)) {
    if (!is_unsure) {
      best = nothing_yet();
      around(scan, kWheels, matcher, best);  // which may fit as well as any other: the surest is
                                             // not to be missed
      around(scan, widest(scan, kRough), matcher, best);
    }
    around(scan, widest(scan, kOther), matcher, best);
    weights = sensing::updated(scan.weights, best.log_likelihoods);
  }
  return concluded(scan, best, weights, matcher);
}

/// Steps that are like the ones before are likely; where the scan does not fit under them as it
/// usually does, or the map contradicts a part of it, any step is looked for.
ExplainedStep MixtureMatch::explain_without_odometry(const StepToExplain& scan,
                                                     ScanMatcher& matcher) {
  Best best = nothing_yet();
  const std::size_t likely = scan.steps.size() - kLikelySteps;
  const auto fits_as_usual = [&] {
    return scan.history.size() >= kStepsToKnow &&
           best.registered.matched_share - best.contradicted_share > scan.usual_share - kUsualDrop;
  };
  for (std::size_t i = scan.steps.size(); i-- > likely;) around(scan, i, matcher, best);
  for (std::size_t i = 0; i < likely && !fits_as_usual(); ++i) around(scan, i, matcher, best);
  return concluded(scan, best, sensing::updated(scan.weights, best.log_likelihoods), matcher);
}

/// Without a match under the best explanation nothing is learned of odometry, and the prediction by
/// odometry stands: next to a vehicle that fills the view, the scan matches the map a little under
/// any explanation.
ExplainedStep MixtureMatch::concluded(const StepToExplain& scan, const Best& best,
                                      const sensing::ExplanationWeights& weights,
                                      ScanMatcher& matcher) const {
  const bool contradicts_wheels = scan.steps.front().is_by_wheels() && best.step != kWheels;
  const double least_share = contradicts_wheels ? std::max(config_.trust.least_matched_share,
                                                           kLeastOfUsualShare * scan.usual_share)
                                                : config_.trust.least_matched_share;
  const auto register_under = [&](const Step& step, const geometry::Pose2& start) {
    scan.take_points(step);
    return matcher.register_from(start, step.prior(),
                                 {scan.points.matched(), scan.map.surfels(), step});
  };
  if (best.registered.matched_share >= least_share) {
    const Step& step = scan.steps[best.step];
    const auto registered = register_under(step, best.registered.map_from_base.pose);
    if (!contradicts_wheels || registered.matched_share >= least_share)
      return {step, registered, weights, searches_};
  }
  const Step& step = scan.steps[kWheels];
  return {step, register_under(step, step.after.odom_from_base), scan.weights, searches_};
}

}  // namespace slammot::localization
