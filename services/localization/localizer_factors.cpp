#include "services/localization/localizer.hpp"

namespace slammot::localization {

/// Odometry whose ways or turns clearly have another factor is corrected by it from the next scan
/// on.
void Localizer::watch_factors(const sensing::LaserScan& scan) {
  if (!config_.odometry.watches_factors || !config_.belief.enabled) return;
  const OdometryPrediction::LastScan& last = *prediction_.last();
  if (!last.has_wheels) return factors_.begin_anew();
  const auto found =
      factors_.observe({scan.scanner.scanner_id, last.wheel_from_base, points_.matched()},
                       prediction_.state().belief.factors);
  if (!found) return;
  prediction_.rescale(*found);
  counters_.recalibrations = prediction_.state().belief.recalibrations;
  keyframes_.resume({});
  lateness_ = LatenessWatch(config_);  // what it found was found with the other factors
  before_scan_.reset();                // before it odometry had the other factors
}

sensing::OdometryConclusions Localizer::odometry_conclusions() const {
  return episodes_.conclusions(calibration(), applies_stamp_offset() ? stamp_offset_s() : 0.0);
}

}  // namespace slammot::localization
