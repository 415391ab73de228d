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

/// What has to be done to recorded poses and beams before they mean what a log's format says.
struct LogCorrection {
  double range_unit_m = 1.0;          ///< Metres a recorded unit of range.
  double way_unit_m = 1.0;            ///< Metres a recorded unit of odometry's position.
  double heading_unit_rad = 1.0;      ///< Radians a recorded unit of odometry's heading.
  bool mirrors_position = false;      ///< y of odometry changes sign.
  bool mirrors_heading = false;       ///< Heading of odometry changes sign.
  bool integrates_turns_anew = false; ///< Positions were made of turns with the wrong sign: with PoseCorrection, motions are put together again.
  double position_turn_rad = 0.0;     ///< Turns positions about the origin, after they are mirrored.
  bool reverses_beams = false;        ///< The last beam is the first of the layout.
  double field_factor = 1.0;          ///< On directions of beams, in the laser's frame.
  double laser_turn_rad = 0.0;        ///< Added to the laser's heading in base.

  bool operator==(const LogCorrection&) const = default;
};

/// Recorded pose as it should have been recorded, heading in (-pi, pi]. Of turns with the wrong sign the mirror image, which is right but
/// for motions sideways.
geometry::Pose2 corrected(const LogCorrection& correction, const geometry::Pose2& recorded);

/// The same of poses one after the other, exact also where turns had the wrong sign.
class PoseCorrection {
 public:
  geometry::Pose2 next(const LogCorrection& correction, const geometry::Pose2& recorded);

 private:
  std::optional<geometry::Pose2> last_recorded_;  ///< In metres and radians,
  geometry::Pose2 last_;                          ///< and as it should have been.
};

/// Whether positions of odometry go where its headings point, step by step. Steps lie along the heading in their middle,
/// forward or backward, up to a constant angle; of mirrored positions they do so with the heading's sign changed.
class OdometryCheck {
 public:
  void add(const geometry::Pose2& recorded);  ///< Heading as written, not wrapped.

  bool is_in_degrees() const;
  bool positions_are_mirrored() const;        ///< Relative to the headings; says not which of the two is right.
  /// Chords turn the other way than headings do, or a point far off the turning axle moves as if behind it: the turns' sign is wrong.
  /// unit_m: of the positions.
  bool turns_against_its_arcs(double unit_m = 1.0) const;
  /// Chords turn as headings do, or a point far off the axle moves as ahead of it. Neither where the arcs of single steps are not seen.
  bool turns_with_its_arcs(double unit_m = 1.0) const;
  double mirrored_direction_rad() const;      ///< Of positions less mirrored headings, modulo pi.

 private:
  double arcs_per_turn() const;
  std::optional<double> ahead_of_axle_m(double unit_m) const;

  struct Unit {
    double radians = 1.0;
    std::complex<double> along = {};      ///< Sum of way * exp(2i (direction - heading)),
    std::complex<double> mirrored = {};   ///< and of way * exp(2i (direction + heading)).
    double arc = 0.0;                ///< Sum of way * sin(direction - heading) * turn,
    double arc_turn = 0.0;           ///< and of way * turn^2.
    Eigen::Matrix2d turning = Eigen::Matrix2d::Zero();           ///< Normal equations of sideways = ahead * turn + k * forward * turn.
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

/// Two scans of a drive, ranges in recorded units, NaN for no echo.
struct ScanPair {
  std::vector<float> first;
  std::vector<float> second;
  geometry::Pose2 first_recorded;   ///< Pose by odometry, as written,
  geometry::Pose2 second_recorded;  ///< and of the second.
  std::size_t first_scan = 0;       ///< Counted from 0.
  std::size_t second_scan = 0;
};

/// How beams are laid out by what is stated or assumed.
struct AssumedBeams {
  double first_beam_rad = 0.0;
  double beam_step_rad = 0.0;
  double laser_heading_rad = 0.0;  ///< In base.
};

/// What a quick match of pairs of scans says of a log.
struct LogEvidence {
  LogCorrection correction;
  bool handedness_is_told = true;     ///< Off where scans and all of odometry turn differently, and nothing tells which of the two is mirrored.
  std::size_t pairs = 0;              ///< Matched well.
  std::size_t turning_pairs = 0;      ///< Of these, with a turn by odometry.
  double matched_share = 0.0;         ///< Of the pairs tried.
  double turn_sign_share = 0.0;       ///< Of turning pairs: turn by scans has the sign of odometry's, as recorded.
  double turn_scale = 0.0;            ///< Turn by scans over turn by odometry, median, corrected; 0 unknown.
  double way_scale = 0.0;             ///< Way by scans over way by odometry, median, corrected; 0 unknown.
  std::vector<ScanPairMotion> motions;   ///< Of the matched pairs, in metres.
};

/// Matches the pairs by correlation under the stated layout and draws conclusions where many pairs agree: units, signs,
/// field of view, mounting. range_unit_m: as the readings alone say; where that is not metres, odometry decides between
/// millimetres and centimetres.
LogEvidence weigh_log(std::span<const ScanPair> pairs, const AssumedBeams& beams, const OdometryCheck& odometry, double range_unit_m);

/// Metres a unit of readings with this median and 90th percentile: no scanner sees 100 m at half of its beams, and none
/// ends at 2.5 m.
double range_unit_of(double median_reading, double far_reading);

}  // namespace slammot::matching
