#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::files {

/// Seconds written in decimal, as nanoseconds without any rounding error of a double; "12.5", "1575810072.324471".
/// Digits beyond the ninth are cut off. Whole milliseconds, microseconds or nanoseconds since 1970 are told by their size. nullopt for what is no number or no time within 290 years.
std::optional<std::int64_t> parse_stamp_ns(std::string_view text);

/// A CARMEN record has two clocks; a field that does not hold a time is nullopt.
struct CarmenStamps {
  std::optional<std::int64_t> ipc_ns;     ///< When the scanner's or the base's message was made.
  std::optional<std::int64_t> logger_ns;  ///< When the logger wrote it, since its start.
};

enum class LaserRecordKind : std::uint8_t {
  kFlaser,       ///< FLASER, RLASER: with the vehicle's pose by odometry.
  kRobotLaser1,  ///< ROBOTLASERn: with the laser's pose and the vehicle's.
  kRawLaser,     ///< RAWLASERn, LASERn: as the scanner sent it, without a pose.
  kDpSlam,       ///< "Laser n r1 ... rn" of DP-SLAM: without pose and time.
  kBag,          ///< A message of a ROS bag.
};

/// How the record says that its beams lie; the field of view counts from the first to the last beam.
struct BeamLayout {
  double first_beam_rad = 0.0;
  double beam_step_rad = 0.0;                          ///< Negative where the beams go clockwise.
};

/// One scan. Poses are finite and as written: a heading may be beyond pi, or in degrees. Ranges are as written (NaN where the text is "nan" or too big).
struct LaserRecord {
  LaserRecordKind kind = LaserRecordKind::kFlaser;
  std::uint8_t slot = 1;                               ///< Which scanner of the vehicle: 1 front, 2 rear, more. Records of one slot and of several kinds tell the same scans.
  std::string scanner = "FLASER";                      ///< As the log names it: message type or topic.
  std::optional<BeamLayout> layout;                    ///< FLASER does not say.
  double max_range_m = 0.0;                            ///< 0 where the record does not say.
  std::vector<float> range_m;
  geometry::Pose2 wheel_from_base;
  std::optional<geometry::Pose2> base_from_laser;      ///< ROBOTLASERn: from its two poses; bags: from the transforms.
  CarmenStamps stamps;
};

enum class OdometryRecordKind : std::uint8_t {
  kOdom,     ///< ODOM, DP-SLAM's Odometry, messages of bags.
  kTruePos,  ///< What TRUEPOS says of the wheels: the same again where the log has ODOM, too.
};

/// One line ODOM or its like.
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

/// One line PARAM.
struct ParamRecord {
  std::string_view name;  ///< Points into the line.
  std::string_view value;
};

/// A comment, an empty line, or a message that is no input of ours.
struct IgnoredLine {};

/// A record of ours that cannot be right: too few numbers, letters instead of numbers, a pose that is not finite.
struct MalformedLine {};

using CarmenRecord = std::variant<IgnoredLine, MalformedLine, ParamRecord, ImuRecord, OdometryRecord, LaserRecord>;

/// Scans of one beam or of more than this are malformed: indices of beams are 16 bits wide, samples on the bus at most 128 kB.
inline constexpr std::size_t kMaxBeams = 8192;

/// Understands one line of a CARMEN log. FLASER and RLASER carry 180 degrees by convention, and so no layout.
/// Formats: CARMEN, "log file format" (carmen.sourceforge.net/doc/binary__loggerplayback.html). Also lines of DP-SLAM's logs
/// (Eliazar and Parr 2004), "Odometry x y heading" and "Laser n r1 ... rn", which have no stamps.
CarmenRecord parse_carmen_line(std::string_view line);

/// What first beam, field of view and step, each rounded, say of the beams, as exactly as they allow; nullopt where they
/// contradict each other or make no sense. field_rad > 0, step_rad >= 0 (0: not said).
std::optional<BeamLayout> layout_of_record(double first_beam_rad, double field_rad, double step_rad, std::size_t beam_count);

/// Layout of a scan that does not say: symmetric to the laser's x axis, a step of field/n for an even number of beams
/// (the last beam is one step short: 180, 360) and field/(n - 1) for an odd one (both ends are in: 181, 361).
BeamLayout layout_by_convention(std::size_t beam_count, double field_of_view_rad);

}  // namespace slammot::files
