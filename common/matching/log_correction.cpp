#include "common/matching/log_correction.hpp"

namespace slammot::matching {

using geometry::Pose2;
using geometry::wrap_angle;

Pose2 corrected(const LogCorrection& correction, const Pose2& recorded) {
  if (correction == LogCorrection{})
    return {recorded.x_m, recorded.y_m, wrap_angle(recorded.heading_rad)};
  const double y_m = correction.mirrors_position ? -recorded.y_m : recorded.y_m;
  const double heading_rad = recorded.heading_rad * correction.heading_unit_rad *
                             (correction.mirrors_heading ? -1.0 : 1.0);
  const geometry::Vector2 position_m =
      geometry::rotation(correction.position_turn_rad) *
      geometry::Vector2{correction.way_unit_m * recorded.x_m, correction.way_unit_m * y_m};
  return {position_m.x(), position_m.y(), wrap_angle(heading_rad)};
}

/// With turns of another size, each step bends by as much more or less.
Pose2 PoseCorrection::next(const LogCorrection& correction, const Pose2& recorded) {
  return turned(correction, recorded) * correction.odometry_from_base;
}

Pose2 PoseCorrection::turned(const LogCorrection& correction, const Pose2& recorded) {
  const Pose2 pose = in_order(correction, recorded);
  if (correction.turn_factor == 1.0) return pose;
  if (last_in_order_) {
    const Pose2 motion = inverse(*last_in_order_) * pose;
    const double turn_rad = correction.turn_factor * motion.heading_rad;
    const geometry::Vector2 moved_m =
        geometry::rotation(0.5 * (turn_rad - motion.heading_rad)) * motion.translation_m();
    last_turned_ = last_turned_ * Pose2{moved_m.x(), moved_m.y(), turn_rad};
  } else {
    last_turned_ = pose;
  }
  last_in_order_ = pose;
  return last_turned_;
}

Pose2 PoseCorrection::in_order(const LogCorrection& correction, const Pose2& recorded) {
  if (!correction.integrates_turns_anew) return corrected(correction, recorded);
  const Pose2 in_units{correction.way_unit_m * recorded.x_m, correction.way_unit_m * recorded.y_m,
                       recorded.heading_rad * correction.heading_unit_rad};
  if (last_recorded_) {
    Pose2 motion = inverse(*last_recorded_) * in_units;
    motion.heading_rad = -motion.heading_rad;
    last_ = last_ * motion;
  }
  last_recorded_ = in_units;
  return last_;
}

}  // namespace slammot::matching
