#include "services/localization/localizer.hpp"

#include <utility>

namespace slammot::localization {
namespace {

sensing::LaserScan without_beams(const sensing::LaserScan& scan) {
  return {scan.stamp_ns, scan.sequence, scan.scanner, {}};
}

}  // namespace

Localizer::Localizer(const LocalizerConfig& config, work::SideWork* help)
    : config_(config),
      intake_(config.odometry.far_ahead_s),
      expected_(config),
      estimator_(config, help),
      submaps_(config, help),
      description_(config, help),
      integration_(config) {}

std::optional<flow::LocalizedScan> Localizer::localize(const sensing::LaserScan& scan,
                                                       flow::LocalizedScan workspace) {
  switch (intake_.judge(scan, prediction(), submaps_.map(), counters_)) {
    case ScanIntake::Use::kDropped: return std::nullopt;
    case ScanIntake::Use::kPredicted: return predict_blank(scan, std::move(workspace));
    case ScanIntake::Use::kWithoutReadings:
      return localize_in_order(without_beams(scan), std::move(workspace));
    case ScanIntake::Use::kLocalized: break;
  }
  return localize_in_order(intake_.without_floor(scan, prediction(), counters_),
                           std::move(workspace));
}

flow::LocalizedScan Localizer::localize_in_order(const sensing::LaserScan& scan,
                                                 flow::LocalizedScan workspace) {
  ++counters_.scans.localized;
  count(integration_.integrate_overdue(scan.stamp_ns, trust(), submaps_.map()), counters_);
  if (prediction().last())
    counters_.map.submaps += submaps_.begin_next_if_due(estimator_.odom_from_base());
  estimator_.begin_scan(intake_.accept(scan, prediction()));
  if (prediction().last()) place_next(scan);
  else begin(scan);
  if (is_lost()) submaps_.measurements().lose_place();
  else submaps_.measurements().place(scan.stamp_ns, estimator_.odom_from_base());
  return describe_placed(scan, std::move(workspace));
}

/// A blank scan measures nothing: its pose is the prediction, the estimate stays as it is, and
/// nothing goes into the map. Its labels are awaited like those of any scan.
std::optional<flow::LocalizedScan> Localizer::predict_blank(const sensing::LaserScan& scan,
                                                            flow::LocalizedScan workspace) {
  if (scan.range_m.empty() || !prediction().last() || !intake_.accept_blank(scan))
    return std::nullopt;
  const Step step = prediction().predict(scan.stamp_ns);
  return describe_and_remember(without_beams(scan),
                               {step.after, step.speed_mps, step.yaw_rate_radps},
                               MapAdmission::kWithheld, std::move(workspace));
}

/// The first scan: the map begins where it is.
void Localizer::begin(const sensing::LaserScan& scan) {
  submaps_.begin();
  estimator_.begin(scan);
}

void Localizer::place_next(const sensing::LaserScan& scan) {
  const bool was_lost = trust() == PoseTrust::kDoubted;
  before_scan_ = progress();
  if (!place(scan) || was_lost)
    before_scan_.reset();  // labels by a map in which it may be elsewhere are worth nothing
  if (estimator_.correct_odometry(scan, counters_))
    before_scan_.reset();  // before it odometry was read otherwise
}

/// False where its match is not believed.
bool Localizer::place(const sensing::LaserScan& scan) {
  return estimator_.place(
      {scan, expected_.masks_at(scan.stamp_ns), submaps_, integration_, counters_});
}

flow::LocalizedScan Localizer::describe_placed(const sensing::LaserScan& scan,
                                               flow::LocalizedScan workspace) {
  const OdometryPrediction::LastScan& last = *prediction().last();
  return describe_and_remember(scan, {prediction().estimate(), last.speed_mps, last.yaw_rate_radps},
                               estimator_.admission(), std::move(workspace));
}

flow::LocalizedScan Localizer::describe_and_remember(const sensing::LaserScan& scan,
                                                     const EstimateAtScan& now,
                                                     MapAdmission admission,
                                                     flow::LocalizedScan workspace) {
  const PublishedPose published = estimator_.published(now.estimate);
  const ScanPoints& points = estimator_.points();
  flow::LocalizedScan localized =
      description_.describe({.scan = scan,
                             .points = points,
                             .map = submaps_.map(),
                             .odom_from_base = published.within_local_map(),
                             .map_from_odom = submaps_.map_from_odom(),
                             .speed_mps = now.speed_mps,
                             .yaw_rate_radps = now.yaw_rate_radps,
                             .sweep_s = estimator_.sweep().sweep_s(scan)},
                            std::move(workspace));
  integration_.remember({scan, localized, points.all_in_base_m(), description_.beams_in_odom(),
                         points.companion_beams()},
                        admission, submaps_.map());
  localized.odom_from_base = published.odom_from_base;
  localized.local_variance_share = published.local_variance_share;
  return localized;
}

Localizer::Progress Localizer::progress() const {
  return {estimator_.state(), submaps_.travelled(), counters_, integration_.integrated_scans()};
}

void Localizer::return_to(const Progress& progress) {
  estimator_.set_state(progress.estimate);
  submaps_.set_travelled(progress.travelled);
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
  if (!estimator_.leave_out(labels)) return std::nullopt;  // the same points give the same pose
  const Progress with_more_points = progress();
  return_to(*before_scan_);
  const sensing::LaserScan& seen = intake_.without_floor_again(scan);
  if (!place(seen)) {
    return_to(with_more_points);
    return std::nullopt;
  }
  integration_.forget_last();
  return describe_placed(seen, {});
}

void Localizer::integrate(const flow::ScanLabels& labels) {
  const bool was_awaited = integration_.awaits(labels);
  count(integration_.integrate(labels, trust(), submaps_.map()), counters_);
  if (was_awaited) expected_.drive_over(labels, submaps_.map());
}

void Localizer::finish() {
  count(integration_.integrate_all(trust(), submaps_.map()), counters_);
  if (prediction().last()) counters_.map.submaps += submaps_.finish(estimator_.odom_from_base());
}

void Localizer::go_on_after(const flow::CorrectedSubmap& last) {
  if (!prediction().last()) submaps_.go_on_after(last);
}

}  // namespace slammot::localization
