#pragma once

#include "services/localization/localization_monitor.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/published_covariance.hpp"
#include "services/localization/sweep_estimate.hpp"

namespace slammot::localization {

/// All of the pose's estimate that a scan changes; what is kept of odometry is not in it.
struct PoseState {
  OdometryPrediction::State prediction;
  LocalizationMonitor::State monitor;
  PublishedCovariance::State covariance;
  SweepFactor sweep_factor;
};

}  // namespace slammot::localization
