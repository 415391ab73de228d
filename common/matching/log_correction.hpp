#pragma once

#include <optional>

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// Corrections that bring recorded poses and beams to the conventions of the log format.
struct LogCorrection {
  double range_unit_m = 1.0;           ///< Metres per recorded unit of range.
  double way_unit_m = 1.0;             ///< Metres per recorded unit of odometry's position.
  double heading_unit_rad = 1.0;       ///< Radians per recorded unit of odometry's heading.
  bool mirrors_position = false;       ///< y of odometry changes sign.
  bool mirrors_heading = false;        ///< Heading of odometry changes sign.
  bool integrates_turns_anew = false;  ///< Positions were integrated with the wrong turn sign:
                                       ///< PoseCorrection integrates the motions again.
  double turn_factor = 1.0;            ///< On odometry's turns, after mirroring: PoseCorrection
                                       ///< integrates the motions again.
  double position_turn_rad = 0.0;      ///< Rotates positions about the origin, after mirroring.
  bool reverses_beams = false;         ///< The last beam is the first of the layout.
  double field_factor = 1.0;           ///< Factor on beam directions, in the laser's frame.
  geometry::Pose2 odometry_from_base;  ///< Base in the frame of the pose that odometry gives,
                                       ///< without heading: PoseCorrection takes it from there.
  double laser_turn_rad = 0.0;         ///< Added to the laser's heading in base.

  bool operator==(const LogCorrection&) const = default;
};

/// Corrected pose, heading in (-pi, pi]. For turns with the wrong sign it returns the mirror image,
/// which is right except for sideways motion.
geometry::Pose2 corrected(const LogCorrection& correction, const geometry::Pose2& recorded);

/// The same for a sequence of poses, exact also if turns had the wrong sign.
class PoseCorrection {
 public:
  geometry::Pose2 next(const LogCorrection& correction, const geometry::Pose2& recorded);

 private:
  geometry::Pose2 turned(const LogCorrection& correction, const geometry::Pose2& recorded);
  geometry::Pose2 in_order(const LogCorrection& correction, const geometry::Pose2& recorded);

  std::optional<geometry::Pose2> last_recorded_;  ///< Last recorded pose, in metres and radians.
  geometry::Pose2 last_;                          ///< Last corrected pose.
  std::optional<geometry::Pose2> last_in_order_;  ///< Before the turns have another size,
  geometry::Pose2 last_turned_;                   ///< and afterwards.
};

}  // namespace slammot::matching
