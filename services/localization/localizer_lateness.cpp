#include "services/localization/localizer.hpp"

namespace slammot::localization {

void Localizer::add_odometry(const sensing::Odometry& sample) {
  prediction_.add(sample);
  if (config_.odometry.watches_lateness) lateness_.add(sample);
}

/// Odometry that is clearly late or early is read at another time from the next scan on.
void Localizer::watch_lateness(const sensing::LaserScan& scan) {
  const bool may_be_late = config_.motion.stamp_offset_prior_s > 0.0;
  if (!config_.odometry.watches_lateness || !config_.odometry.time_is_known || !may_be_late) return;
  const OdometryPrediction::LastScan& last = *prediction_.last();
  if (monitor_.is_lost() || !last.has_wheels || has_rare_scans()) return lateness_.begin_anew();
  const double in_use_s = applies_stamp_offset() ? stamp_offset_s() : 0.0;
  const auto found = lateness_.observe({scan.stamp_ns, scan.scanner.scanner_id,
                                        last.wheel_from_base, odom_from_base(), points_.matched()},
                                       in_use_s);
  if (!found) return;
  ++counters_.retimed_odometry;
  prediction_.retime(found->late_s, found->sigma_s);
  keyframes_.resume({});
  lateness_.begin_anew();
  before_scan_.reset();  // before it odometry was read at the other time
}

}  // namespace slammot::localization
