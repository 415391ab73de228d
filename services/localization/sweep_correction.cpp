#include "services/localization/sweep_correction.hpp"

#include <Eigen/LU>

namespace slammot::localization {

SweepCorrection::SweepCorrection(const LocalizerConfig& config)
    : variance_at_start_(config.echoes.sweep_factor_sigma * config.echoes.sweep_factor_sigma),
      match_(config.match) {
  factor_.variance = variance_at_start_;
}

double SweepCorrection::sweep_s(const sensing::LaserScan& scan) const {
  return learns(scan) ? factor_.value * scan.scanner.sweep_s : scan.scanner.sweep_s;
}

const sensing::LaserScan& SweepCorrection::corrected(const sensing::LaserScan& scan) {
  if (!learns(scan)) return scan;
  corrected_ = scan;
  corrected_.scanner.sweep_s = sweep_s(scan);
  return corrected_;
}

void SweepCorrection::observe(const sensing::LaserScan& scan, const Step& step,
                              const ScanPoints& points, const ScanMatch& match,
                              const grids::SurfelMap& surfels) {
  if (!match.is_believed || match.was_sampled || !learns(scan)) return;
  share_of_sweep_.clear();
  for (const std::size_t beam : points.matched_beams())
    share_of_sweep_.push_back(static_cast<double>(beam) / static_cast<double>(scan.range_m.size()));
  const SweptScan swept{points.matched(),
                        share_of_sweep_,
                        match.odom_from_base.pose,
                        step.prior().covariance.inverse(),
                        scan.scanner.sweep_s,
                        {step.speed_mps, step.yaw_rate_radps},
                        step.duration_s};
  factor_ = learned(factor_, swept, surfels, match_, variance_at_start_);
}

}  // namespace slammot::localization
