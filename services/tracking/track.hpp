#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "common/flow/ids.hpp"
#include "services/tracking/existence.hpp"
#include "services/tracking/extent.hpp"
#include "services/tracking/history.hpp"
#include "services/tracking/kinematics.hpp"
#include "services/tracking/object_class.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// One object that is followed, or a hypothesis of one.
struct Track {
  flow::TrackId track_id;
  flow::TrackId object_id;  ///< Published. That of an earlier track where the object was found
                            ///< again.
  Kinematics kinematics;
  Extent extent;
  Existence existence;
  Classification classification;
  History history;

  Eigen::Vector2d position_m() const { return kinematics.position_m(); }
  Eigen::Vector2d velocity_mps() const { return kinematics.velocity_mps(); }
  bool is_confirmed() const { return existence.confirmed; }
  const Footprint& footprint() const { return extent.footprint(); }
};

/// True for a box that is not a bicycle.
bool is_vehicle(const Track& track);

/// Largest speed of a pedestrian [m/s].
inline constexpr double kFastestWalkMps = 2.7;

/// True for a confirmed track that is certainly a pedestrian by the sizes and speeds observed so
/// far. Stays true while the filter overestimates the speed (docs/decisions/motion-models.md). Such
/// a track never becomes a box: larger echoes around it are companions or a wall
/// (docs/decisions/existence-and-publication.md).
bool is_known_pedestrian(const Track& track);

/// True for a known pedestrian, and for any small and slow blob: its measured centre moves with the
/// gait.
bool may_be_pedestrian(const Track& track);

/// Moves the reference point of the position in all parts of the track; the velocity stays. The
/// estimate is the caller's to combine.
void shift(Track& track, const Eigen::Vector2d& by_m, const TrackingConfig& config);

/// Predicts kinematics and heading over time_s >= 0, and selects the motion modes.
void predict(Track& track, double time_s, const TrackingConfig& config);

/// True if the velocity is known well enough to be published.
bool has_published_velocity(const Track& track, const TrackingConfig& config);

/// Updates the class by the present speed, if known, and the sizes.
void update_class(Track& track, double time_s, const TrackingConfig& config);

/// Marks the track as an object that moves, and classifies it by its present speed.
void confirm(Track& track, std::int64_t stamp_ns, const TrackingConfig& config);

}  // namespace slammot::tracking
