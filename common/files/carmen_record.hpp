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
/// Digits beyond the ninth are cut off. nullopt for what is no number or no time within 290 years.
std::optional<std::int64_t> parse_stamp_ns(std::string_view text);

/// A CARMEN record has two clocks; a field that does not hold a time is nullopt.
struct CarmenStamps {
  std::optional<std::int64_t> ipc_ns;     ///< When the scanner's or the base's message was made.
  std::optional<std::int64_t> logger_ns;  ///< When the logger wrote it, since its start.
};

enum class LaserRecordKind : std::uint8_t { kFlaser, kRobotLaser1 };

/// How the record says that its beams lie; the field of view counts from the first to the last beam.
struct BeamLayout {
  double first_beam_rad = 0.0;
  double beam_step_rad = 0.0;
};

/// One line FLASER or ROBOTLASER1. Poses are finite, ranges are as written (NaN where the text is "nan" or too big).
struct LaserRecord {
  LaserRecordKind kind = LaserRecordKind::kFlaser;
  std::optional<BeamLayout> layout;                    ///< FLASER does not say.
  double max_range_m = 0.0;                            ///< 0 where the record does not say.
  std::vector<float> range_m;
  geometry::Pose2 wheel_from_base;
  std::optional<geometry::Pose2> base_from_laser;      ///< ROBOTLASER1: from its two poses.
  CarmenStamps stamps;
};

/// One line ODOM.
struct OdometryRecord {
  geometry::Pose2 wheel_from_base;
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

using CarmenRecord = std::variant<IgnoredLine, MalformedLine, ParamRecord, OdometryRecord, LaserRecord>;

/// Scans of one beam or of more than this are malformed: indices of beams are 16 bits wide, samples on the bus at most 128 kB.
inline constexpr std::size_t kMaxBeams = 8192;

/// Understands one line of a CARMEN log. FLASER carries 180 degrees by convention, and so no layout.
/// Formats: CARMEN, "log file format" (carmen.sourceforge.net/doc/binary__loggerplayback.html).
CarmenRecord parse_carmen_line(std::string_view line);

/// Layout of a scan that does not say: symmetric to the laser's x axis, a step of field/n for an even number of beams
/// (the last beam is one step short: 180, 360) and field/(n - 1) for an odd one (both ends are in: 181, 361).
BeamLayout layout_by_convention(std::size_t beam_count, double field_of_view_rad);

}  // namespace slammot::files
