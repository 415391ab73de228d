#pragma once

#include <functional>

#include "common/traffic/passage.hpp"

namespace slammot::traffic {

using geometry::Vector2;

/// A vehicle at the speed along a curve of the way travelled, ten scans a second.
inline Passage passage_along(const std::function<Vector2(double)>& position_at_m, double length_m,
                             double speed_mps = 10.0) {
  constexpr double kScanS = 0.1;
  constexpr double kStepM = 1e-3;
  Passage passage{Mover::kVehicle, 2.0, {}};
  for (int scan = 0; scan * kScanS * speed_mps <= length_m; ++scan) {
    const double way_m = scan * kScanS * speed_mps;
    const Vector2 step_m = position_at_m(way_m + kStepM) - position_at_m(way_m - kStepM);
    MoverState state;
    state.stamp_ns = scan * 100'000'000LL;
    state.position_in_map_m = position_at_m(way_m);
    state.velocity_in_map_mps = speed_mps * step_m.normalized();
    state.covariance = 0.01 * Eigen::Matrix4d::Identity();
    passage.states.push_back(state);
  }
  return passage;
}

inline Passage straight(const Vector2& from_m, const Vector2& to_m, double speed_mps = 10.0) {
  const Vector2 direction = (to_m - from_m).normalized();
  return passage_along([=](double way_m) { return Vector2(from_m + way_m * direction); },
                       (to_m - from_m).norm(), speed_mps);
}

}  // namespace slammot::traffic
