#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/sensing/aids.hpp"
#include "common/sensing/spatial_mounting.hpp"

namespace slammot::files {

/// Parses decimal seconds to nanoseconds without the rounding of a double; "12.5",
/// "1575810072.324471". Digits beyond the ninth are cut off. Integer milliseconds, microseconds or
/// nanoseconds since 1970 are recognised by their size. nullopt if it is no number, or no time
/// within 290 years.
std::optional<std::int64_t> parse_stamp_ns(std::string_view text);

/// The two clocks of a CARMEN record; nullopt for an invalid time.
struct CarmenStamps {
  std::optional<std::int64_t> ipc_ns;     ///< Creation of the message by the scanner or base.
  std::optional<std::int64_t> logger_ns;  ///< Writing by the logger, since its start.
};

enum class LaserRecordKind : std::uint8_t {
  kFlaser,       ///< FLASER, RLASER: with the vehicle's pose by odometry.
  kRobotLaser1,  ///< ROBOTLASERn: with the laser's pose and the vehicle's.
  kRawLaser,     ///< RAWLASERn, LASERn: as the scanner sent it, without a pose.
  kDpSlam,       ///< "Laser n r1 ... rn" of DP-SLAM: without pose and time.
  kBag,          ///< A message of a ROS bag.
};

/// Beam layout of a record; the field of view is from the first to the last beam.
struct BeamLayout {
  double first_beam_rad = 0.0;
  double beam_step_rad = 0.0;  ///< Negative for clockwise beams.
};

/// One scan. Poses are finite and as recorded: headings may be beyond pi, or in degrees. Ranges are
/// as recorded (NaN if "nan" or too large).
struct LaserRecord {
  LaserRecordKind kind = LaserRecordKind::kFlaser;
  std::uint8_t slot = 1;  ///< 1 front scanner, 2 rear, more. Several kinds in one slot repeat the
                          ///< same scans.
  std::string scanner = "FLASER";    ///< Name in the log: message type or topic.
  std::optional<BeamLayout> layout;  ///< None for FLASER.
  double max_range_m = 0.0;          ///< 0 if not in the record.
  std::vector<float> range_m;
  geometry::Pose2 wheel_from_base;
  std::optional<geometry::Pose2> base_from_laser;  ///< ROBOTLASERn: from its two poses; bags: from
                                                   ///< the transforms.
  std::optional<sensing::SpatialMounting> profile_mounting;  ///< Bags: of a scanner that scans
                                                             ///< vertically.
  CarmenStamps stamps;
};

enum class OdometryRecordKind : std::uint8_t {
  kOdom,     ///< ODOM, DP-SLAM's Odometry, messages of bags.
  kTruePos,  ///< Odometry in TRUEPOS: a duplicate if the log has ODOM, too.
};

/// One ODOM line or its equivalent.
struct OdometryRecord {
  geometry::Pose2 wheel_from_base;
  CarmenStamps stamps;
  OdometryRecordKind kind = OdometryRecordKind::kOdom;
};

/// One line IMU, or one message of a bag.
struct ImuRecord {
  double yaw_rate_radps = 0.0;
  CarmenStamps stamps;
};

/// One line NMEAGGA: the receiver's sentence GGA. stamp_ns of the fix is not set.
struct GnssRecord {
  sensing::GnssFix fix;
  CarmenStamps stamps;
};

/// One line NMEAHDT: a heading against true north. stamp_ns of the reading is not set.
struct CompassRecord {
  sensing::CompassReading reading;
  CarmenStamps stamps;
};

/// One line PARAM.
struct ParamRecord {
  std::string_view name;  ///< Points into the line.
  std::string_view value;
};

/// A comment, an empty line, or an unused message.
struct IgnoredLine {};

/// An invalid record: too few numbers, letters for numbers, or a pose that is not finite.
struct MalformedLine {
  std::string_view why = {};  ///< Of static storage; empty if nothing more is known.
};

using CarmenRecord = std::variant<IgnoredLine, MalformedLine, ParamRecord, ImuRecord,
                                  OdometryRecord, LaserRecord, GnssRecord, CompassRecord>;

/// Scans with one beam or more than this are malformed: beam indices have 16 bits, samples on the
/// bus at most 128 kB.
inline constexpr std::size_t kMaxBeams = 8192;

/// Parses one line of a CARMEN log. FLASER and RLASER cover 180 degrees by convention and have no
/// layout. Formats: CARMEN, "log file format"
/// (carmen.sourceforge.net/doc/binary__loggerplayback.html). Also DP-SLAM's lines (Eliazar and Parr
/// 2004) "Odometry x y heading" and "Laser n r1 ... rn", which have no stamps.
CarmenRecord parse_carmen_line(std::string_view line);

/// Most accurate layout consistent with rounded values of first beam, field of view and step;
/// nullopt if they contradict each other or are invalid. field_rad > 0, step_rad >= 0 (0: unknown).
std::optional<BeamLayout> layout_of_record(double first_beam_rad, double field_rad, double step_rad,
                                           std::size_t beam_count);

/// Layout of a scan without one: symmetric to the laser's x axis. The step is field/n for an even
/// number of beams (the last beam is one step short: 180, 360) and field/(n - 1) for an odd one
/// (both ends included: 181, 361).
BeamLayout layout_by_convention(std::size_t beam_count, double field_of_view_rad);

}  // namespace slammot::files
