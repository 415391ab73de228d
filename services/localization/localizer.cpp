#include "services/localization/localizer.hpp"

#include <utility>

namespace slammot::localization {
namespace {

void count(const Step& step, LocalizerCounters& counters) {
  if (step.is_gap) ++counters.gaps;
  if (step.has_doubted_wheels) ++counters.odometry_jumps;
  else if (!step.is_by_wheels()) ++counters.without_odometry;
}

/// With what was concluded of it.
sensing::OdometryStep odometry_step(const Step& step, const ScanMatch& match,
                                    const sensing::WheelFactors& factors) {
  sensing::OdometryStep record{.stamp_ns = step.stamp_ns,
                               .duration_s = step.duration_s,
                               .explanation = step.explanation,
                               .is_jump = step.has_doubted_wheels};
  if (step.has_wheels() || step.has_doubted_wheels)
    record.by_wheels = sensing::corrected(step.uncorrected_by_wheels, step.duration_s, factors);
  if (match.is_believed && !match.is_lost) record.by_matches = matched_step(step, match);
  return record;
}

void count(const ScanMatch& match, LocalizerCounters& counters) {
  if (match.was_searched) ++counters.searches;
  if (match.was_sampled) ++counters.sampled_matches;
  if (match.is_lost) ++counters.lost_matches;
  else if (!match.is_believed) ++counters.too_few_echoes;
}

void count(const IntegrationCounts& integrated, LocalizerCounters& counters) {
  counters.withheld_scans += integrated.withheld_scans;
  counters.fallback_integrations += integrated.fallback_integrations;
  counters.restored_points += integrated.restored_points;
}

}  // namespace

Localizer::Localizer(const LocalizerConfig& config, work::SideWork* help)
    : config_(config),
      order_(config.odometry.far_ahead_s),
      prediction_(config),
      sweep_(config),
      expected_(config),
      points_(config),
      matcher_(config, help),
      mixture_(config),
      keyframes_(config),
      lateness_(config),
      monitor_(config),
      relocalization_(config),
      covariance_(config),
      submaps_(config, help),
      description_(config, help),
      integration_(config) {}

std::optional<std::int64_t> Localizer::last_stamp_ns() const {
  return prediction_.last() ? std::optional(prediction_.last()->stamp_ns) : std::nullopt;
}

bool Localizer::is_in_order(const sensing::LaserScan& scan) {
  switch (order_.judge(scan, last_stamp_ns())) {
    case ScanOrder::Verdict::kUsable: return true;
    case ScanOrder::Verdict::kDuplicate: ++counters_.duplicate_scans; break;
    case ScanOrder::Verdict::kOutOfOrder: ++counters_.out_of_order_scans; break;
    case ScanOrder::Verdict::kFarAhead: ++counters_.far_ahead_scans; break;
  }
  return false;
}

std::optional<flow::LocalizedScan> Localizer::localize(const sensing::LaserScan& scan,
                                                       flow::LocalizedScan workspace) {
  if (!is_in_order(scan)) return std::nullopt;
  const bool is_frozen =
      frozen_.repeats(scan, prediction_.wheel_from_base_at(scan.stamp_ns)) && prediction_.last();
  counters_.frozen_scans += is_frozen ? 1 : 0;
  if (is_frozen && has_rare_scans())
    return localize_in_order(frozen_.without_readings(scan), std::move(workspace));
  const bool is_blank = !is_frozen && measures_nothing(scan);
  counters_.blank_scans += is_blank ? 1 : 0;
  if (is_frozen || is_blank) return predict_blank(scan, std::move(workspace));
  return localize_in_order(scan, std::move(workspace));
}

flow::LocalizedScan Localizer::localize_in_order(const sensing::LaserScan& scan,
                                                 flow::LocalizedScan workspace) {
  ++counters_.scans;
  count(integration_.integrate_overdue(scan.stamp_ns, monitor_.trust(), submaps_.map()), counters_);
  if (prediction_.last()) counters_.submaps += submaps_.begin_next_if_due(odom_from_base());
  order_.accept(scan, last_stamp_ns());
  points_.begin_scan(companions_.of(scan, prediction_.wheel_from_base_at(scan.stamp_ns)));
  if (prediction_.last()) place_next(scan);
  else begin(scan);
  if (monitor_.is_lost()) submaps_.measurements().lose_place();
  else submaps_.measurements().place(scan.stamp_ns, odom_from_base());
  return describe_and_remember(scan, estimate_at_last_scan(), monitor_.admission(),
                               std::move(workspace));
}

/// The first scan: the map begins where it is.
void Localizer::begin(const sensing::LaserScan& scan) {
  submaps_.begin();
  points_.deskew(scan, 0.0, 0.0);
  prediction_.begin(scan.stamp_ns);
  episodes_.begin(scan.stamp_ns);
}

void Localizer::place_next(const sensing::LaserScan& scan) {
  const bool was_lost = monitor_.trust() == PoseTrust::kDoubted;
  before_scan_ = progress();
  if (!place(scan) || was_lost)
    before_scan_.reset();  // labels by a map in which it may be elsewhere are worth nothing
  watch_factors(scan);
  watch_lateness(scan);
}

/// Takes the estimate to a scan after the first. False where its match is not believed.
bool Localizer::place(const sensing::LaserScan& scan) {
  Step step = prediction_.predict(scan.stamp_ns);
  count(step, counters_);
  take_points(scan, step);
  const std::optional<ExplainedStep> explained = explain_or_doubt(scan, step);
  if (explained) step = explained->step;
  const ScanMatch found =
      match_or_relocalize(scan, step, explained ? &explained->registered : nullptr);
  const sensing::OdometryStep concluded =
      odometry_step(step, found, prediction_.state().belief.factors);
  prediction_.observe(step, found);
  episodes_.observe(concluded, prediction_.state().belief.factors);
  counters_.recalibrations = prediction_.state().belief.recalibrations;
  covariance_.observe(step, found);
  sweep_.observe(scan, step, points_, found, submaps_.map().surfels());
  submaps_.travel(matched_step(step, found));
  if (found.is_believed && !found.is_lost) compare_odometry(scan, step, found);
  if ((found.is_lost && monitor_.begins_elsewhere()) || monitor_.has_gone_astray(scan.stamp_ns))
    begin_astray_map(*monitor_.lost_since_ns());
  return found.is_believed && !found.is_lost && monitor_.trust() == PoseTrust::kConfirmed;
}

void Localizer::compare_odometry(const sensing::LaserScan& scan, const Step& step,
                                 const ScanMatch& found) {
  if (!config_.belief.enabled) return;
  const auto comparison = keyframes_.observe(
      {step, found.odom_from_base.pose, points_, scan.scanner.scanner_id, prediction_});
  if (!comparison) return;
  submaps_.doubt(geometry::rotation(found.odom_from_base.pose.heading_rad) *
                 prediction_.compare(*comparison));
}

ScanMatch Localizer::match_or_relocalize(const sensing::LaserScan& scan, const Step& step,
                                         const matching::PointToLineResult* registered) {
  ScanMatch found = matcher_.match(
      {points_.matched(), submaps_.map().surfels(), step, scan.sequence, registered});
  count(found, counters_);
  const auto verdict = monitor_.judge(
      {found, step, prediction_.state().belief.usual_share, points_, submaps_.map()});
  found.is_lost = verdict != LocalizationMonitor::Verdict::kFits;
  if (verdict == LocalizationMonitor::Verdict::kLost) found = relocalize(step).value_or(found);
  if (found.is_believed && !found.is_lost && monitor_.confirm())
    integration_.integrate_doubted(submaps_.map());
  return found;
}

std::optional<ScanMatch> Localizer::relocalize(const Step& step) {
  count(integration_.drop_doubted(), counters_);
  const RelocalizationResult result =
      relocalization_.find(monitor_.lost_scans(), step, points_, submaps_.map(), matcher_);
  counters_.searches += result.has_searched;
  counters_.found_again += result.found.has_value();
  return result.found;
}

/// Nothing that was seen before is of use here: the map begins with this scan, and the pose against
/// it is exact.
void Localizer::begin_astray_map(std::int64_t since_ns) {
  ++counters_.astray;
  counters_.submaps += submaps_.begin_astray(odom_from_base(), since_ns);
  prediction_.begin_map_here();
  monitor_.begin_map();
  count(integration_.drop_doubted(), counters_);
}

Localizer::EstimateAtScan Localizer::estimate_at_last_scan() const {
  const OdometryPrediction::LastScan& last = *prediction_.last();
  return {prediction_.estimate(), last.speed_mps, last.yaw_rate_radps};
}

flow::LocalizedScan Localizer::describe_and_remember(const sensing::LaserScan& scan,
                                                     const EstimateAtScan& now,
                                                     MapAdmission admission,
                                                     flow::LocalizedScan workspace) {
  const PublishedPose published = covariance_.published(now.estimate, monitor_.is_lost());
  flow::LocalizedScan localized =
      description_.describe({.scan = scan,
                             .points = points_,
                             .map = submaps_.map(),
                             .odom_from_base = published.within_local_map(),
                             .map_from_odom = submaps_.map_from_odom(),
                             .speed_mps = now.speed_mps,
                             .yaw_rate_radps = now.yaw_rate_radps,
                             .sweep_s = sweep_.sweep_s(scan)},
                            std::move(workspace));
  integration_.remember({scan, localized, points_.all_in_base_m(), description_.beams_in_odom(),
                         points_.companion_beams()},
                        admission, submaps_.map());
  localized.odom_from_base = published.odom_from_base;
  localized.local_variance_share = published.local_variance_share;
  return localized;
}

Localizer::Progress Localizer::progress() const {
  return {prediction_.state(),
          covariance_.state(),
          sweep_.factor(),
          submaps_.travelled(),
          monitor_.state(),
          counters_,
          integration_.integrated_scans()};
}

void Localizer::return_to(const Progress& progress) {
  prediction_.set_state(progress.prediction);
  covariance_.set_state(progress.covariance);
  sweep_.set_factor(progress.sweep_factor);
  submaps_.set_travelled(progress.travelled);
  monitor_.set_state(progress.monitor);
  counters_ = progress.counters;
}

bool Localizer::can_be_placed_again(const sensing::LaserScan& scan,
                                    const std::vector<flow::PointLabel>& labels) const {
  if (!before_scan_ || !config_.echoes.leave_out_moving ||
      before_scan_->integrated_scans != integration_.integrated_scans())
    return false;
  return integration_.awaits_last(scan) && labels.size() == scan.range_m.size();
}

std::optional<flow::LocalizedScan> Localizer::localize_again(
    const sensing::LaserScan& scan, const std::vector<flow::PointLabel>& labels) {
  if (!can_be_placed_again(scan, labels)) return std::nullopt;
  if (!points_.leave_out(labels)) return std::nullopt;  // the same points give the same pose
  const Progress with_more_points = progress();
  return_to(*before_scan_);
  if (!place(scan)) {
    return_to(with_more_points);
    return std::nullopt;
  }
  integration_.forget_last();
  return describe_and_remember(scan, estimate_at_last_scan(), monitor_.admission(), {});
}

void Localizer::integrate(const flow::ScanLabels& labels) {
  const bool was_awaited = integration_.awaits(labels);
  count(integration_.integrate(labels, monitor_.trust(), submaps_.map()), counters_);
  if (was_awaited) expected_.drive_over(labels, submaps_.map());
}

void Localizer::finish() {
  count(integration_.integrate_all(monitor_.trust(), submaps_.map()), counters_);
  if (prediction_.last()) counters_.submaps += submaps_.finish(odom_from_base());
}

void Localizer::go_on_after(const flow::CorrectedSubmap& last) {
  if (!prediction_.last()) submaps_.go_on_after(last);
}

}  // namespace slammot::localization
