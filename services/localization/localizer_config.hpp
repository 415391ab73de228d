#pragma once

#include <numbers>

#include "common/matching/correlative.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/sensing/motion_model.hpp"
#include "common/sensing/odometry_belief.hpp"
#include "common/sensing/variance_factor.hpp"
#include "services/localization/ambiguous_match.hpp"
#include "services/localization/local_map.hpp"

namespace slammot::localization {

/// Kinds of vehicles, numbered as in slammot.proto.
enum class Vehicle { car, robot };

/// Models of the errors of published poses, numbered as in slammot.proto.
enum class PoseErrorModel { road, building, model_cars };

/// Which echoes are used, and what they are worth.
struct EchoConfig {
  double match_range_m = 80.0;      ///< Echoes beyond it are not matched,
  double map_range_m = 80.0;        ///< and beyond this not mapped.
  double min_range_m = 0.3;         ///< Nearer echoes come from the vehicle itself.
  double range_noise_m = 0.03;      ///< One sigma of a range at the scanner.
  double sweep_factor_sigma = 0.0;  ///< Of the factor on the duration of a sweep; 0: it is as
                                    ///< configured.
  bool leave_out_moving = true;  ///< Off to measure its worth: everything is mapped and matched as
                                 ///< stationary.
  bool expects_all_ranges = false;  ///< Publishes the expected range of every beam, not only of
                                    ///< those near an echo that contradicts it.
};

/// What odometry and stamps may say.
struct OdometryConfig {
  bool use_odometry = true;       ///< Off for wheels that are worse than none: constant velocity
                                  ///< predicts.
  bool time_is_known = true;      ///< Off where the log has no clock and stamps were made up: no
                                  ///< speed has a meaning.
  bool may_be_picked_up = false;  ///< And set down elsewhere without a sign of the wheels.
  double fastest_mps = 60.0;      ///< A faster step by odometry is a jump.
  double longest_step_s = 2.0;    ///< Without odometry the longest extrapolation; longer gaps are
                                  ///< counted.
  bool watches_lateness = true;  ///< Finds odometry's lateness by pairs of scans while driving. Off
                                 ///< where a log was examined before.
  bool watches_factors = true;   ///< The same for factors of its ways and turns.
  double far_ahead_s = 60.0;     ///< A stamp so far ahead of those before is believed when a second
                                 ///< one agrees.
};

/// Search by correlation around a vague prediction, before the match.
struct SearchConfig {
  double when_sigma_m = 0.15;            ///< A prediction less sure than this is searched for,
  double when_heading_sigma_rad = 0.02;  ///< or less sure of the heading than this.
  double reach_m = 25.0;                 ///< Half side of the square of the map that is searched.
  double sigmas = 3.0;  ///< Half width of the window in standard deviations of the prediction.
  matching::CorrelativeConfig correlative;
};

/// When a match is believed.
struct MatchTrustConfig {
  double least_matched_share = 0.3;  ///< With fewer points matched, the match is not believed.
  bool mover_may_fill_view = true;   ///< Points of the largest body (match.body_length_m) count no
                                     ///< more than all others together.
  double body_sigma_without_wheels_m = 0.15;  ///< match.body_sigma_m without odometry: whatever has
                                              ///< most of the beams may be driving off.
  AmbiguousMatchConfig ambiguous;
};

/// What happens after the pose was lost.
struct RecoveryConfig {
  bool recovers = true;          ///< Searches for the pose after the vehicle was carried away; off:
                                 ///< goes on by dead reckoning.
  double lost_after_s = 3.0;     ///< Time without a match that odometry bridges; then the pose is
                                 ///< searched for.
  double astray_sigma_m = 50.0;  ///< One sigma of the tie between two maps where the vehicle lost
                                 ///< its way.

  /// Covariance of a pose of which next to nothing is known.
  geometry::Matrix3 anywhere() const {
    const double sigma_m2 = astray_sigma_m * astray_sigma_m;
    return Eigen::Vector3d(sigma_m2, sigma_m2, std::numbers::pi * std::numbers::pi).asDiagonal();
  }
};

/// Errors of published poses and of the constraints between submaps.
struct PoseErrorConfig {
  double drift_m_per_sqrt_m = 0.005;      ///< What dead reckoning by matching adds, one sigma, for
                                          ///< submap constraints.
  double drift_rad_per_sqrt_m = 0.0002;   ///< Over 100 m that is 0.1 degrees; simulated drives show
                                          ///< 0.04 to 0.06.
  double variance_by_scans_alone = 13.0;  ///< Without wheels, published variances over those within
                                          ///< the local map: measured by NEES on simulated drives.
  /// Of published covariances; measured by NEES on simulated drives:
  /// docs/decisions/pose-covariance.md. Positions err with the way, headings with each scan.
  sensing::PoseErrors pose_errors{
      .forward = {.of_scan = 0.0002, .of_surprises = 1.6, .of_map = 0.01, .view_m = 0.15},
      .sideways = {.of_scan = 0.0005, .of_surprises = 2.1, .of_map = 0.0, .view_m = 0.03},
      .heading = {.of_scan = 0.019, .of_surprises = 0.03, .of_map = 0.0, .view_m = 0.1}};
};

/// Defaults are for road vehicles.
struct LocalizerConfig {
  Vehicle vehicle = Vehicle::car;                          ///< Set by set_vehicle(),
  PoseErrorModel pose_error_model = PoseErrorModel::road;  ///< and by set_pose_error_model().
  EchoConfig echoes;
  OdometryConfig odometry;
  sensing::OdometryBeliefConfig belief;
  sensing::MotionModelConfig motion;
  LocalMapConfig map;
  SearchConfig search;
  matching::PointToLineConfig match;
  MatchTrustConfig trust;
  RecoveryConfig recovery;
  PoseErrorConfig errors;
};

}  // namespace slammot::localization
