#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "services/tracking/observation.hpp"
#include "services/tracking/road_users.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Log-odds of existence of a new track.
inline constexpr double kBirthScore = -1.0;

/// What is known of an object at its first observation.
struct FirstObservation {
  flow::TrackId track_id;
  std::int64_t stamp_ns = 0;
  Observation observation;
  double box_heading_rad = 0.0;                                  ///< Of the longer visible side.
  Eigen::Matrix2d pose_covariance_m2 = Eigen::Matrix2d::Zero();  ///< Of the vehicle's pose, at the
                                                                 ///< object.
};

/// A tentative track at rest. It refers to the road users for its whole life.
Track initiated(const FirstObservation& first, const TrackingConfig& config,
                const RoadUsers& road_users = kRoadUsersAnywhere);

/// The same in the memory of a track that has ended.
void initiate(Track& track, const FirstObservation& first, const TrackingConfig& config,
              const RoadUsers& road_users);

/// The track as far as its last published message tells.
Track track_from_message(const flow::TrackedObject& object, const TrackingConfig& config);

}  // namespace slammot::tracking
