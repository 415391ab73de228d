#pragma once

#include <cmath>
#include <ostream>

#include <gmock/gmock.h>

#include "common/geometry/pose2.hpp"

namespace slammot::geometry {

inline void PrintTo(const Pose2& pose, std::ostream* out) {
  *out << "(" << pose.x_m << " m, " << pose.y_m << " m, " << pose.heading_rad << " rad)";
}

}  // namespace slammot::geometry

namespace slammot::testing {

MATCHER_P2(PoseNear, expected, tolerance,
           "is within " + ::testing::PrintToString(tolerance) + " of " +
               ::testing::PrintToString(expected)) {
  return std::hypot(arg.x_m - expected.x_m, arg.y_m - expected.y_m) <= tolerance &&
         std::abs(geometry::wrap_angle(arg.heading_rad - expected.heading_rad)) <= tolerance;
}

MATCHER_P2(MatrixNear, expected, tolerance,
           "is within " + ::testing::PrintToString(tolerance) + " of\n" +
               ::testing::PrintToString(expected)) {
  return (arg - expected).cwiseAbs().maxCoeff() <= tolerance;
}

}  // namespace slammot::testing
