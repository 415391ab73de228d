#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

namespace slammot::joint_posterior {

/// Ways to estimate vehicle, landmarks and movers from the same observations.
enum class Method : std::uint8_t {
  kGeneric,          ///< One filter, any object may move: SLAM with generic objects, Section 2.4.
  kJoint,            ///< One filter; which objects are landmarks is known.
  kDecomposed,       ///< SLAM over landmarks, and a tracker a mover with the pose's covariance:
                     ///< Section 2.5.
  kPoseTakenAsTrue,  ///< The same without the pose's covariance.
};

inline constexpr std::array kMethods = {Method::kGeneric, Method::kJoint, Method::kDecomposed,
                                        Method::kPoseTakenAsTrue};

std::string_view name_of(Method method);

/// Objects of a world.
struct Crowd {
  std::size_t landmarks = 0;
  std::size_t movers = 0;
};

/// Means over drives, after the first seconds; NEES per degree of freedom, 1 if consistent.
struct Score {
  double pose_rmse_m = 0.0;
  double heading_rmse_rad = 0.0;
  double pose_nees = 0.0;  ///< Of x, y and heading.
  double mover_rmse_m = 0.0;
  double velocity_rmse_mps = 0.0;
  double mover_nees = 0.0;  ///< Of x and y in world.
  double numbers = 0.0;     ///< In the covariances at the end: of one filter its size squared.
  double step_us = 0.0;     ///< Time of a period.
};

/// Time of the machine [s]; only differences count.
using Clock = std::function<double()>;

/// Drives of one minute with seeds 1 to `seeds`.
Score score_of(Method method, const Crowd& crowd, int seeds, const Clock& now_s);

}  // namespace slammot::joint_posterior
