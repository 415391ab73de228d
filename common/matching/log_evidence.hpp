#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"
#include "common/matching/odometry_lateness.hpp"

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

/// Tests whether odometry's positions move along its headings, step by step. A step lies along the
/// heading in its middle, forward or backward, up to a constant angle. Mirrored positions do so
/// with the heading's sign changed.
class OdometryCheck {
 public:
  void add(const geometry::Pose2& recorded);  ///< The heading is unwrapped, as recorded.

  bool is_in_degrees() const;
  bool positions_are_mirrored() const;  ///< Relative to the headings; does not say which of the two
                                        ///< is correct.
  /// True if chords turn against the headings, or if a point far from the turning axle moves as if
  /// behind it: the turns' sign is wrong. unit_m: metres per unit of the positions.
  bool turns_against_its_arcs(double unit_m = 1.0) const;
  /// True if chords turn with the headings, or if a point far from the axle moves as if ahead of
  /// it. Neither is true if arcs of single steps are not observable.
  bool turns_with_its_arcs(double unit_m = 1.0) const;
  double mirrored_direction_rad() const;  ///< Direction of positions minus mirrored headings,
                                          ///< modulo pi.

 private:
  double arcs_per_turn() const;
  std::optional<double> ahead_of_axle_m(double unit_m) const;

  struct Unit {
    double radians = 1.0;
    std::complex<double> along = {};     ///< Sum of way * exp(2i (direction - heading)).
    std::complex<double> mirrored = {};  ///< Sum of way * exp(2i (direction + heading)).
    double arc = 0.0;                    ///< Sum of way * sin(direction - heading) * turn.
    double arc_turn = 0.0;               ///< Sum of way * turn^2.
    Eigen::Matrix2d turning = Eigen::Matrix2d::Zero();  ///< Normal equations of sideways = ahead *
                                                        ///< turn + k * forward * turn.
    Eigen::Vector2d sideways = Eigen::Vector2d::Zero();
    double squared_sideways = 0.0;
    int steps = 0;
  };
  const Unit& unit() const { return units_[is_in_degrees() ? 1 : 0]; }

  std::array<Unit, 2> units_{Unit{.radians = 1.0}, Unit{.radians = std::numbers::pi / 180.0}};
  double way_ = 0.0;
  double largest_heading_ = 0.0;
  std::optional<geometry::Pose2> before_;
};

/// Two scans of a drive; ranges in recorded units, NaN for no echo.
struct ScanPair {
  std::vector<float> first;
  std::vector<float> second;
  geometry::Pose2 first_recorded;   ///< Odometry pose of the first scan, as recorded.
  geometry::Pose2 second_recorded;  ///< Odometry pose of the second scan, as recorded.
  std::size_t first_scan = 0;       ///< Counted from 0.
  std::size_t second_scan = 0;
};

/// Beam layout, stated or assumed.
struct AssumedBeams {
  double first_beam_rad = 0.0;
  double beam_step_rad = 0.0;
  double laser_heading_rad = 0.0;  ///< In base.
  geometry::Vector2 laser_in_base_m = geometry::Vector2::Zero();
};

/// Result of matching pairs of scans of a log.
struct LogEvidence {
  LogCorrection correction;
  bool handedness_is_told = true;  ///< False if scans and odometry turn differently and nothing
                                   ///< tells which is mirrored.
  std::size_t pairs = 0;           ///< Number of well matched pairs.
  std::size_t turning_pairs = 0;   ///< Of these, pairs with a turn by odometry.
  double matched_share = 0.0;      ///< Share of the tried pairs.
  double turn_sign_share = 0.0;  ///< Share of turning pairs whose turn by scans has the sign of the
                                 ///< recorded odometry's.
  double turn_scale = 0.0;       ///< Median of turn by scans over corrected turn by odometry; 0:
                                 ///< unknown.
  double way_scale = 0.0;  ///< Median of way by scans over corrected way by odometry; 0: unknown.
  std::vector<ScanPairMotion> motions;  ///< Of the matched pairs, in metres.
};

/// Matches the pairs by correlation under the stated layout, and infers units, signs, field of view
/// and mounting where many pairs agree. range_unit_m: estimated from the readings alone. If it is
/// not metres, odometry decides between millimetres and centimetres.
LogEvidence weigh_log(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                      const OdometryCheck& odometry, double range_unit_m);

/// Metres per unit of readings with this median and 90th percentile. Assumes that no scanner sees
/// 100 m at half of its beams, and that none has a range limit of 2.5 m.
double range_unit_of(double median_reading, double far_reading);

}  // namespace slammot::matching
