#pragma once

#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/sensing/scan.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_match.hpp"
#include "services/localization/scan_points.hpp"
#include "services/localization/sweep_estimate.hpp"

namespace slammot::localization {

/// Applies to scans how long their sweep is estimated to take, and learns that from matches; where
/// sweep_factor_sigma is 0 scanners are right.
class SweepCorrection {
 public:
  explicit SweepCorrection(const LocalizerConfig& config);

  /// How long the scan's sweep is estimated to take.
  double sweep_s(const sensing::LaserScan& scan) const;

  /// The scan with that for its sweep. Valid until the next call, and as long as the scan.
  const sensing::LaserScan& corrected(const sensing::LaserScan& scan);

  /// Feedback: the step, points and match of a scan.
  void observe(const sensing::LaserScan& scan, const Step& step, const ScanPoints& points,
               const ScanMatch& match, const grids::SurfelMap& surfels);

  const SweepFactor& factor() const { return factor_; }
  void set_factor(const SweepFactor& factor) { factor_ = factor; }

 private:
  bool learns(const sensing::LaserScan& scan) const {
    return factor_.variance > 0.0 && scan.scanner.sweep_s > 0.0;
  }

  double variance_at_start_;
  matching::PointToLineConfig match_;
  SweepFactor factor_;
  sensing::LaserScan corrected_;        ///< Kept to reuse the memory,
  std::vector<double> share_of_sweep_;  ///< as is this.
};

}  // namespace slammot::localization
