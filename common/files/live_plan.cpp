#include "common/files/live_plan.hpp"

namespace slammot::files {

LogPlan as_live(LogPlan plan) {
  const matching::LogCorrection found = plan.evidence.correction;
  matching::LogCorrection& correction = plan.evidence.correction;
  correction = {};
  correction.range_unit_m = found.range_unit_m;
  correction.way_unit_m = found.way_unit_m;
  correction.heading_unit_rad = found.heading_unit_rad;
  plan.base_from_laser.heading_rad =
      geometry::wrap_angle(plan.base_from_laser.heading_rad - found.laser_turn_rad);
  if (!plan.scanners.empty()) plan.scanners.front().base_from_laser = plan.base_from_laser;
  for (ScannerPlan& scanner : plan.scanners) {
    scanner.own_body = {};
    scanner.floor.from.clear();  // It is said all the same.
  }
  if (plan.times.fault == sensing::ClockFault::kNoisy) plan.times = {};
  plan.odometry = plan.recorded_odometry;
  plan.odometry_held_scans = 0;
  plan.odometry_smoothed_over = 0;
  plan.odometry_is_too_noisy = false;
  plan.odometry_is_too_rare = false;
  plan.odometry_late_s = 0.0;
  plan.odometry_drift = 0.0;
  plan.odometry_stamps_ns.clear();
  plan.odometry_stamp_noise_s = 0.0;
  return plan;
}

}  // namespace slammot::files
