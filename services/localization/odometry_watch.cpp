#include "services/localization/odometry_watch.hpp"

namespace slammot::localization {
namespace {

/// With what was concluded of it.
sensing::OdometryStep odometry_step(const Step& step, const ScanMatch& match,
                                    const sensing::WheelFactors& factors) {
  sensing::OdometryStep record{.stamp_ns = step.stamp_ns,
                               .duration_s = step.duration_s,
                               .explanation = step.explanation,
                               .is_jump = step.wheels.are_doubted};
  if (step.has_wheels() || step.wheels.are_doubted)
    record.by_wheels = sensing::corrected(step.wheels.uncorrected, step.duration_s, factors);
  if (match.is_believed && !match.is_lost) record.by_matches = matched_step(step, match);
  return record;
}

double offset_in_use_s(const OdometryPrediction& prediction) {
  return prediction.state().applies_stamp_offset ? prediction.stamp_offset_s() : 0.0;
}

}  // namespace

OdometryWatch::OdometryWatch(const LocalizerConfig& config)
    : config_(config), keyframes_(config), lateness_(config) {}

void OdometryWatch::add(const sensing::Odometry& sample) {
  if (config_.odometry.watches_lateness) lateness_.add(sample);
}

void OdometryWatch::record(const Placed& placed, const sensing::WheelFactors& factors,
                           const sensing::WheelFactors& next_factors) {
  episodes_.observe(odometry_step(placed.step, placed.match, factors), next_factors);
}

std::optional<geometry::Vector2> OdometryWatch::compare(const Placed& placed,
                                                        OdometryPrediction& prediction) {
  const ScanMatch& match = placed.match;
  if (!match.is_believed || match.is_lost || !config_.belief.enabled) return std::nullopt;
  if (placed.step.slip.is_active()) {
    keyframes_.resume({});  // ways by odometry have the slip in them
    lateness_.begin_anew();
    factors_.begin_anew();
    return std::nullopt;
  }
  const auto comparison = keyframes_.observe({placed.step, match.odom_from_base.pose, placed.points,
                                              placed.scan.scanner.scanner_id, prediction});
  if (!comparison) return std::nullopt;
  return geometry::rotation(match.odom_from_base.pose.heading_rad) *
         prediction.compare(*comparison);
}

bool OdometryWatch::rescales(const sensing::LaserScan& scan, const ScanPoints& points,
                             OdometryPrediction& prediction) {
  if (!config_.odometry.watches_factors || !config_.belief.enabled) return false;
  const OdometryPrediction::LastScan& last = *prediction.last();
  if (!last.has_wheels) {
    factors_.begin_anew();
    return false;
  }
  const auto found =
      factors_.observe({scan.scanner.scanner_id, last.wheel_from_base, points.matched()},
                       prediction.state().belief.factors);
  if (!found) return false;
  prediction.rescale(*found);
  keyframes_.resume({});
  lateness_ = LatenessWatch(config_);  // what it found was found with the other factors
  return true;
}

bool OdometryWatch::retimes(const sensing::LaserScan& scan, const ScanPoints& points, bool is_lost,
                            OdometryPrediction& prediction) {
  const bool may_be_late = config_.motion.stamp_offset_prior_s > 0.0;
  if (!config_.odometry.watches_lateness || !config_.odometry.time_is_known || !may_be_late)
    return false;
  const OdometryPrediction::LastScan& last = *prediction.last();
  if (is_lost || !last.has_wheels || prediction.has_rare_scans()) {
    lateness_.begin_anew();
    return false;
  }
  const auto found =
      lateness_.observe({scan.stamp_ns, scan.scanner.scanner_id, last.wheel_from_base,
                         prediction.estimate().odom_from_base, points.matched()},
                        offset_in_use_s(prediction));
  if (!found) return false;
  prediction.retime(found->late_s, found->sigma_s);
  keyframes_.resume({});
  lateness_.begin_anew();
  return true;
}

sensing::OdometryConclusions OdometryWatch::conclusions(
    const OdometryPrediction& prediction) const {
  return episodes_.conclusions(prediction.estimate().calibration, offset_in_use_s(prediction));
}

void OdometryWatch::resume(const KeyframeOdometry::State& keyframes, std::int64_t last_stamp_ns) {
  keyframes_.resume(keyframes);
  episodes_.begin(last_stamp_ns);
}

}  // namespace slammot::localization
