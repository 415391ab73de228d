#include "services/localization/pose_estimator.hpp"

#include <utility>

namespace slammot::localization {

PoseEstimator::PoseEstimator(const LocalizerConfig& config, work::SideWork* help)
    : config_(config),
      prediction_(config),
      sweep_(config),
      points_(config),
      matcher_(config, help),
      mixture_(config),
      monitor_(config),
      relocalization_(config),
      covariance_(config),
      watch_(config) {}

void PoseEstimator::add(const sensing::Odometry& sample) {
  prediction_.add(sample);
  watch_.add(sample);
}

void PoseEstimator::begin(const sensing::LaserScan& scan) {
  points_.deskew(scan, 0.0, 0.0);
  prediction_.begin(scan.stamp_ns);
  watch_.begin(scan.stamp_ns);
}

bool PoseEstimator::place(const ScanToPlace& placed) {
  Step step = prediction_.predict(placed.scan.stamp_ns, sweep_.sweep_s(placed.scan));
  count(step, placed.counters);
  placed.counters.odometry.gaps += step.duration_s > config_.odometry.longest_step_s;
  take_points(placed, step);
  const std::optional<ExplainedStep> explained = explain_or_doubt(placed, step);
  if (explained) step = explained->step;
  const ScanMatch found =
      match_or_relocalize(placed, step, explained ? &explained->registered : nullptr);
  learn(placed, step, found);
  if ((found.is_lost && monitor_.begins_elsewhere()) ||
      monitor_.has_gone_astray(placed.scan.stamp_ns))
    begin_astray_map(placed);
  return found.is_believed && !found.is_lost && monitor_.trust() == PoseTrust::kConfirmed;
}

/// What the match says of the estimate, of odometry and of the sweep.
void PoseEstimator::learn(const ScanToPlace& placed, const Step& step, const ScanMatch& found) {
  const OdometryWatch::Placed matched{placed.scan, step, found, points_};
  const sensing::WheelFactors factors = prediction_.state().belief.factors;
  prediction_.observe(step, found);
  watch_.record(matched, factors, prediction_.state().belief.factors);
  placed.counters.odometry.recalibrations = prediction_.state().belief.recalibrations;
  covariance_.observe(step, found);
  sweep_.observe(placed.scan, step, points_, found, placed.submaps.map().surfels());
  placed.submaps.travel(matched_step(step, found), found);
  if (const auto error_m = watch_.compare(matched, prediction_)) placed.submaps.doubt(*error_m);
}

ScanMatch PoseEstimator::match_or_relocalize(const ScanToPlace& placed, const Step& step,
                                             const matching::PointToLineResult* registered) {
  LocalMap& map = placed.submaps.map();
  ScanMatch found =
      matcher_.match({points_.matched(), map.surfels(), step, placed.scan.sequence, registered});
  count(found, placed.counters);
  const auto verdict =
      monitor_.judge({found, step, prediction_.state().belief.usual_share, points_, map});
  found.is_lost = verdict != LocalizationMonitor::Verdict::kFits;
  if (verdict == LocalizationMonitor::Verdict::kLost)
    found = relocalize(placed, step).value_or(found);
  if (found.is_believed && !found.is_lost && monitor_.confirm())
    placed.integration.integrate_doubted(map);
  return found;
}

std::optional<ScanMatch> PoseEstimator::relocalize(const ScanToPlace& placed, const Step& step) {
  count(placed.integration.drop_doubted(), placed.counters);
  const RelocalizationResult result =
      relocalization_.find(monitor_.lost_scans(), step, points_, placed.submaps.map(), matcher_);
  placed.counters.matches.searches += result.has_searched;
  placed.counters.matches.found_again += result.found.has_value();
  return result.found;
}

/// Nothing that was seen before is of use here: the map begins with this scan, and the pose against
/// it is exact. The vehicle has not been in the map before since it was lost.
void PoseEstimator::begin_astray_map(const ScanToPlace& placed) {
  ++placed.counters.map.astray;
  placed.counters.map.submaps +=
      placed.submaps.begin_astray(odom_from_base(), *monitor_.lost_since_ns());
  prediction_.begin_map_here();
  monitor_.begin_map();
  count(placed.integration.drop_doubted(), placed.counters);
}

bool PoseEstimator::correct_odometry(const sensing::LaserScan& scan, LocalizerCounters& counters) {
  const bool is_rescaled = watch_.rescales(scan, points_, prediction_);
  const bool is_retimed = watch_.retimes(scan, points_, monitor_.is_lost(), prediction_);
  counters.odometry.recalibrations = prediction_.state().belief.recalibrations;
  counters.odometry.retimed += is_retimed;
  return is_rescaled || is_retimed;
}

PoseState PoseEstimator::state() const {
  return {prediction_.state(), monitor_.state(), covariance_.state(), sweep_.factor()};
}

void PoseEstimator::set_state(const PoseState& state) {
  prediction_.set_state(state.prediction);
  covariance_.set_state(state.covariance);
  sweep_.set_factor(state.sweep_factor);
  monitor_.set_state(state.monitor);
}

void PoseEstimator::resume(const Checkpoint& checkpoint, PoseEstimator&& before) {
  const PoseState& pose = checkpoint.pose;
  prediction_.resume(pose.prediction, checkpoint.odometry, std::move(before.prediction_));
  monitor_.set_state(pose.monitor);
  covariance_.set_state(pose.covariance);
  sweep_.set_factor(pose.sweep_factor);
  watch_.resume(checkpoint.keyframes, pose.prediction.last->stamp_ns);
}

}  // namespace slammot::localization
