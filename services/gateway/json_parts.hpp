#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/geometry/pose2.hpp"

/// Parts of the messages in JSON. Identities and stamps of 64 bits are text: JavaScript's numbers
/// hold 53 bits.
namespace slammot::gateway {

using Json = nlohmann::json;

/// [x_m, y_m, heading_rad].
inline Json json_of(const geometry::Pose2& pose) { return {pose.x_m, pose.y_m, pose.heading_rad}; }

/// Row-major.
template <typename Scalar, int kRows, int kColumns>
Json json_of(const Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
  Json json = Json::array();
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column)
      json.push_back(static_cast<double>(matrix(row, column)));
  }
  return json;
}

}  // namespace slammot::gateway
