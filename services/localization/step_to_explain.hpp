#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

#include "common/sensing/odometry_belief.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// A scan, and the mixture of predictions of its pose.
struct StepToExplain {
  StepMixture steps;  ///< One an explanation; odometry as calibrated first, then its heavy tail,
                      ///< then the rest.
  sensing::ExplanationWeights weights;  ///< Before the scan.
  double usual_share = 0.5;             ///< Of points that match.
  const sensing::StepHistory& history;  ///< Of the drive: the prior without odometry.
  const ScanPoints& points;             ///< Under the prediction taken last.
  const LocalMap& map;
  std::function<void(const Step&)> take_points;  ///< Takes the points under another prediction.
};

/// Place of the explanation that knows next to nothing of the step, in a mixture.
inline constexpr std::size_t kOtherStep = 2;

/// Place of a wide explanation; without odometry there is only one.
inline std::size_t widest(const StepToExplain& scan, std::size_t wanted) {
  return std::min(wanted, scan.steps.size() - 1);
}

}  // namespace slammot::localization
