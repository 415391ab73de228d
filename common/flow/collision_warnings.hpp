#pragma once

#include <cstdint>
#include <vector>

#include "common/flow/ids.hpp"

namespace slammot::flow {

enum class WarningLevel : std::uint8_t { kNone, kCaution, kWarning };

/// Predicted encounter of the vehicle with one tracked object, from the stamp on.
struct CollisionWarning {
  TrackId track_id;
  WarningLevel level = WarningLevel::kNone;
  double probability = 0.0;  ///< Of a contact of both footprints within the horizon, [0, 1].
  double time_to_collision_s = 0.0;  ///< Median of the time of the first contact, if there is one;
                                     ///< negative where the probability is 0.
  double closest_distance_m = 0.0;  ///< Of both footprints on their predicted paths; 0: they touch.
  double time_to_closest_s = 0.0;   ///< Until that distance.
};

/// Encounters with all assessed objects at a stamp.
struct CollisionWarnings {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;  ///< Of the scan.
  MapId map_id{};
  OdomId odom_id{};
  double horizon_s = 0.0;                            ///< Of the prediction.
  WarningLevel highest_level = WarningLevel::kNone;  ///< Of all objects.
  std::vector<CollisionWarning> objects;             ///< In the order of the tracks.
};

}  // namespace slammot::flow
