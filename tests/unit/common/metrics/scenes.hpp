#pragma once

#include "common/metrics/scene.hpp"

namespace slammot::metrics {

inline TrueObject car_at(double x_m, double y_m, std::size_t object = 0) {
  return {object, "car", {x_m, y_m, 0.0}, 10.0, 4.0, 2.0, 20};
}

inline ReportedTrack track_at(double x_m, double y_m, std::size_t track = 0) {
  ReportedTrack reported;
  reported.track = track;
  reported.object_class = "car";
  reported.world_from_object = {x_m, y_m, 0.0};
  reported.velocity_in_world_mps = {10.0, 0.0};
  reported.length_m = 4.0;
  reported.width_m = 2.0;
  return reported;
}

}  // namespace slammot::metrics
