#pragma once

#include <vector>

#include "common/traffic/traffic_map.hpp"

namespace slammot::testing {

/// Streams whose members differ: the lane of two cars along x, at y of the submap's frame.
inline std::vector<traffic::FreeStream> example_streams(float y_m = 1.0F) {
  std::vector<traffic::FreeStream> streams;
  for (int i = 0; i < 40; ++i)
    streams.push_back({traffic::Mover::kVehicle,
                       2,
                       {0.5F * static_cast<float>(i), y_m},
                       1.0F,
                       0.8F,
                       {0.79F, 0.01F},
                       8.0F,
                       82.0F,
                       1.6F});
  return streams;
}

/// Bit for bit.
inline bool same_stream(const traffic::FreeStream& a, const traffic::FreeStream& b) {
  return a.mover == b.mover && a.passages == b.passages && a.position_m == b.position_m &&
         a.length_m == b.length_m && a.weight == b.weight && a.direction_sum == b.direction_sum &&
         a.speed_sum_mps == b.speed_sum_mps && a.squared_speed_sum == b.squared_speed_sum &&
         a.width_sum_m == b.width_sum_m;
}

}  // namespace slammot::testing
