#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/filters/imm.hpp"
#include "common/filters/move_stop.hpp"
#include "common/simulation/maneuvers.hpp"

namespace slammot::motion_study {

/// Ways to estimate the motion of an object whose mode is unknown: Wang 2004, Section 2.3 and
/// Chapter 4.
enum class Method : std::uint8_t {
  kConstantVelocity,      ///< One Kalman filter
  kConstantAcceleration,  ///< of one model.
  kGpb1,                  ///< Both models as the mixtures of filters::Mixture.
  kGpb2,
  kImm,
  kImmWithTurn,  ///< The coordinated turn in place of constant acceleration (Section 4.3, case 3).
  kImmWithStop,  ///< The stop model as a third model of the IMM (Section 4.5).
  kMoveStop      ///< IMM and stop hypothesis side by side (Section 4.6).
};

inline constexpr std::array kMethods = {Method::kConstantVelocity,
                                        Method::kConstantAcceleration,
                                        Method::kGpb1,
                                        Method::kGpb2,
                                        Method::kImm,
                                        Method::kImmWithTurn,
                                        Method::kImmWithStop,
                                        Method::kMoveStop};

std::string_view name_of(Method method);

/// Kalman filters that run at each measurement.
int filters_of(Method method);

struct Estimate {
  filters::MotionState state;
  double maneuver_probability = 0.0;  ///< Of the second model.
  bool stands = false;                ///< Decision for the stop model or hypothesis.

  simulation::MotionMode mode() const;
};

/// One of the methods at work on positions measured with simulation::kManeuverSigmaM, one
/// simulation::kManeuverPeriodS apart.
class Estimator {
 public:
  Estimator(Method method, const filters::MotionState& start);

  /// Prediction and update.
  Estimate update(const Eigen::Vector2d& position_m);

 private:
  Method method_;
  filters::ModelSet set_;
  filters::ImmState mixture_;
  filters::MoveStop move_stop_;
};

}  // namespace slammot::motion_study
