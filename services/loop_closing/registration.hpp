#pragma once

#include <span>

#include "common/flow/submap.hpp"
#include "common/geometry/uncertain_pose2.hpp"
#include "services/loop_closing/surfel_index.hpp"

namespace slammot::loop_closing {

struct RegistrationConfig {
  double fine_gate_m = 0.4;        ///< Greatest distance of paired surfels in the last steps.
  double surfel_sigma_m = 0.06;    ///< One sigma of the distance between two surfels of one wall,
                                   ///< across the wall.
  double independent_share = 0.1;  ///< Share of the surfels with an error of their own: neighbours
                                   ///< along a wall have a common one.
  double position_floor_m = 0.02;  ///< Least one-sigma error of a closure's position.
  double heading_floor_rad = 0.002;  ///< Least one-sigma error of a closure's heading.
};

/// Greatest distance of paired surfels in the first steps.
inline double coarse_gate_m(const RegistrationConfig& config) {
  constexpr double kOverFineGate = 2.5;
  return kOverFineGate * config.fine_gate_m;
}

struct Registration {
  geometry::UncertainPose2 target_from_source;
  double matched_share = 0.0;  ///< Share of the source's surfels with a pair.
  double rms_m = 0.0;          ///< Of the distances of paired surfels, across the wall.
};

/// Registers the source's surfels to the target's by Gauss-Newton on point-to-line distances. In
/// directions without information (along a corridor) the pose stays at the initial one and the
/// covariance is metres wide.
Registration register_surfels(std::span<const flow::Surfel> source, const SurfelIndex& target,
                              const geometry::Pose2& initial_target_from_source,
                              const RegistrationConfig& config);

}  // namespace slammot::loop_closing
