#include "examples/motion_study/estimator.hpp"

#include <cstddef>

namespace slammot::motion_study {
namespace {

// The thesis does not say the noises of its models.
const filters::MotionModel kCruise{filters::MotionKind::kConstantVelocity, 0.05, 3.0};
const filters::MotionModel kAccelerate{filters::MotionKind::kConstantAcceleration, 20.0, 0.0};
const filters::MotionModel kTurn{filters::MotionKind::kCoordinatedTurn, 0.5, 0.0};
/// One sigma of the velocity of 0.1 m/s: of the order of the measurement noise (Section 4.4).
const filters::MotionModel kStop{filters::MotionKind::kStop, 0.01, 3.0};
constexpr filters::MoveStopConfig kMoveStop{1.0, 3.0};
constexpr std::size_t kManeuverAt = 1;  ///< Places in the mixtures.
constexpr std::size_t kStopAt = 2;

filters::ModelSet models_of(Method method) {
  filters::ModelSet set;
  set.mean_stay_s = 2.0;
  set.models = {kCruise, kAccelerate, kStop};
  set.size = method == Method::kImmWithStop ? 3 : 2;
  if (method == Method::kGpb1) set.mixture = filters::Mixture::kGpb1;
  if (method == Method::kGpb2) set.mixture = filters::Mixture::kGpb2;
  if (method == Method::kConstantVelocity) set.size = 1;
  if (method == Method::kImmWithTurn) set.models[kManeuverAt] = kTurn;
  if (method == Method::kConstantAcceleration) {
    set.models[0] = kAccelerate;
    set.size = 1;
  }
  return set;
}

}  // namespace

std::string_view name_of(Method method) {
  switch (method) {
    case Method::kConstantVelocity: return "KF, CV";
    case Method::kConstantAcceleration: return "KF, CA";
    case Method::kGpb1: return "GPB1";
    case Method::kGpb2: return "GPB2";
    case Method::kImm: return "IMM";
    case Method::kImmWithTurn: return "IMM, CV and turn";
    case Method::kImmWithStop: return "IMM with stop model";
    case Method::kMoveStop: break;
  }
  return "IMM and stop hypothesis";
}

int filters_of(Method method) {
  const filters::ModelSet set = models_of(method);
  const int models = static_cast<int>(set.size);
  return set.mixture == filters::Mixture::kGpb2 ? models * models : models;
}

simulation::MotionMode Estimate::mode() const {
  if (stands) return simulation::MotionMode::kStands;
  return maneuver_probability > 0.5 ? simulation::MotionMode::kManeuvers
                                    : simulation::MotionMode::kCruises;
}

Estimator::Estimator(Method method, const filters::MotionState& start)
    : method_(method), set_(models_of(method)), mixture_(filters::imm_start(set_, start)) {}

Estimate Estimator::update(const Eigen::Vector2d& position_m) {
  const Eigen::Matrix2d R =
      simulation::kManeuverSigmaM * simulation::kManeuverSigmaM * Eigen::Matrix2d::Identity();
  mixture_ =
      filters::imm_update(set_, filters::imm_predict(set_, mixture_, simulation::kManeuverPeriodS),
                          position_m, R)
          .posterior;
  const filters::MotionState moving = filters::imm_combine(set_, mixture_);
  if (method_ == Method::kMoveStop)
    move_stop_ =
        filters::weigh(move_stop_, {moving, position_m, simulation::kManeuverPeriodS}, kMoveStop);
  return {filters::estimate_of(move_stop_, moving), mixture_.probability[kManeuverAt],
          move_stop_.stands || mixture_.probability[kStopAt] > 0.5};
}

}  // namespace slammot::motion_study
