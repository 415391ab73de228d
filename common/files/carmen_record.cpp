#include "common/files/carmen_record.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

namespace slammot::files {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kMaxStampSeconds = 9'000'000'000;
constexpr double kMaxCoordinateM = 1e7;  // a quarter of the earth's circumference
constexpr std::size_t kPoseNumbers = 3;
constexpr std::size_t kStampWords = 3;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r'; }

/// Returns the words of a line in sequence; an empty word is the end of the line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  std::string_view next() {
    std::size_t begin = 0;
    while (begin < rest_.size() && is_space(rest_[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest_.size() && !is_space(rest_[end])) ++end;
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }

  std::string_view rest() const { return rest_; }
  void skip(std::size_t characters) { rest_.remove_prefix(characters); }

  std::size_t count_left() const {
    Words copy = *this;
    std::size_t count = 0;
    while (!copy.next().empty()) ++count;
    return count;
  }

 private:
  std::string_view rest_;
};

template <typename Number>
std::optional<Number> parse_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  Number number{};
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (fault == std::errc::invalid_argument || end != word.data() + word.size()) return std::nullopt;
  if (fault == std::errc::result_out_of_range) {
    if constexpr (std::is_floating_point_v<Number>) return std::numeric_limits<Number>::quiet_NaN();
    return std::nullopt;
  }
  return number;
}

/// Parses a reading. Nearly all have few digits in plain notation. Digits and power of ten are then
/// exact in a float, so that one division rounds like std::from_chars (Clinger 1990), in one pass.
std::optional<float> next_reading(Words& words) {
  constexpr std::uint32_t kExact = 1 << 24;
  constexpr std::array<float, 8> kPowerOfTen{1e0F, 1e1F, 1e2F, 1e3F, 1e4F, 1e5F, 1e6F, 1e7F};
  const std::string_view rest = words.rest();
  std::size_t begin = 0;
  while (begin < rest.size() && is_space(rest[begin])) ++begin;
  const std::size_t longest = std::min(rest.size(), begin + kPowerOfTen.size());
  std::uint32_t digits = 0;
  std::size_t at = begin;
  for (; at < longest && is_digit(rest[at]); ++at)
    digits = 10 * digits + static_cast<std::uint32_t>(rest[at] - '0');
  const std::size_t point = at;
  if (at > begin && at < longest && rest[at] == '.') {
    for (++at; at < longest && is_digit(rest[at]); ++at)
      digits = 10 * digits + static_cast<std::uint32_t>(rest[at] - '0');
  }
  const bool is_plain = at > begin && at < rest.size() && is_space(rest[at]) && digits <= kExact;
  if (!is_plain) return parse_number<float>(words.next());
  words.skip(at);
  return static_cast<float>(digits) / kPowerOfTen[at > point ? at - point - 1 : 0];
}

std::optional<double> next_finite(Words& words) {
  const std::optional<double> number = parse_number<double>(words.next());
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<geometry::Pose2> next_pose(Words& words) {
  const auto x_m = next_finite(words);
  const auto y_m = next_finite(words);
  const auto heading_rad = next_finite(words);
  if (!x_m || !y_m || !heading_rad) return std::nullopt;
  if (std::abs(*x_m) > kMaxCoordinateM || std::abs(*y_m) > kMaxCoordinateM ||
      std::abs(*heading_rad) > 1e6)
    return std::nullopt;
  return geometry::Pose2{*x_m, *y_m, *heading_rad};
}

CarmenStamps next_stamps(Words& words) {
  CarmenStamps stamps;
  stamps.ipc_ns = parse_stamp_ns(words.next());
  words.next();  // host name
  stamps.logger_ns = parse_stamp_ns(words.next());
  return stamps;
}

std::optional<std::vector<float>> next_ranges(Words& words) {
  const auto count = parse_number<std::uint64_t>(words.next());
  if (!count || *count < 2 || *count > kMaxBeams) return std::nullopt;
  std::vector<float> range_m;
  range_m.reserve(*count);
  for (std::uint64_t beam = 0; beam < *count; ++beam) {
    const auto reading = next_reading(words);
    if (!reading) return std::nullopt;
    range_m.push_back(*reading);
  }
  return range_m;
}

enum class Slot : std::uint8_t { kFront = 1, kRear = 2 };

constexpr MalformedLine kAnotherCount{"it does not hold as many ranges as it says"};

/// True if the host's name is not the second of the last words: all numbers before it are then of
/// other fields than they are taken for. rest: from the scanner's stamp on.
bool host_is_elsewhere(Words rest) {
  constexpr std::size_t kPlaceOfHost = 1;
  bool was_name = false;
  std::size_t place = 0;
  for (std::string_view word = rest.next(); !word.empty(); word = rest.next(), ++place) {
    const bool is_number = parse_number<double>(word).has_value();
    if (was_name && is_number) return place != kPlaceOfHost + 1;
    was_name = !is_number;
  }
  return false;
}

/// FLASER and RLASER.
CarmenRecord parse_flaser(std::string_view keyword, Slot slot, Words words) {
  LaserRecord record;
  record.kind = LaserRecordKind::kFlaser;
  record.slot = static_cast<std::uint8_t>(slot);
  record.scanner = keyword;
  auto range_m = next_ranges(words);
  if (!range_m) return MalformedLine{};
  record.range_m = std::move(*range_m);
  // a mapper may have corrected the first pose; the second one is odometry
  if (!next_pose(words)) return MalformedLine{};
  const auto wheel_from_base = next_pose(words);
  if (!wheel_from_base || words.count_left() == 0) return MalformedLine{};
  if (host_is_elsewhere(words)) return kAnotherCount;
  record.wheel_from_base = *wheel_from_base;
  record.stamps = next_stamps(words);
  return record;
}

/// Skips the remissions, if the record has a count of them; older records do not.
bool skip_remissions(Words& words, std::size_t words_after) {
  const std::size_t left = words.count_left();
  if (left < words_after) return false;
  if (left == words_after) return true;
  Words ahead = words;
  const auto remissions = parse_number<std::uint64_t>(ahead.next());
  if (!remissions || *remissions > left - 1 - words_after) return true;
  for (std::uint64_t i = 0; i < *remissions; ++i) ahead.next();
  words = ahead;
  return true;
}

/// Parses the start of ROBOTLASERn and RAWLASERn: type of scanner, field of view, readings. Returns
/// false for impossible values.
bool parse_configured_ranges(Words& words, LaserRecord& record) {
  words.next();  // type of scanner: redundant
  const auto first_beam_rad = next_finite(words);
  const auto field_rad = next_finite(words);
  const auto step_rad = next_finite(words);
  const auto max_range_m = parse_number<float>(words.next());  // float: a reading of the same
                                                               // digits must compare equal
  words.next();                                                // accuracy
  words.next();                                                // remission mode
  auto range_m = next_ranges(words);
  if (!first_beam_rad || !field_rad || !step_rad || !max_range_m || !range_m) return false;
  record.range_m = std::move(*range_m);
  record.layout = layout_of_record(*first_beam_rad, *field_rad, *step_rad, record.range_m.size());
  record.max_range_m =
      *max_range_m > 0.0F && std::isfinite(*max_range_m) ? static_cast<double>(*max_range_m) : 0.0;
  return true;
}

CarmenRecord parse_robotlaser(std::string_view keyword, std::uint8_t slot, Words words) {
  constexpr std::size_t kWordsAfter = 2 * kPoseNumbers + 5 + kStampWords;
  LaserRecord record;
  record.kind = LaserRecordKind::kRobotLaser1;
  record.slot = slot;
  record.scanner = keyword;
  if (!parse_configured_ranges(words, record) || !skip_remissions(words, kWordsAfter))
    return MalformedLine{};
  const auto wheel_from_laser = next_pose(words);
  const auto wheel_from_base = next_pose(words);
  if (!wheel_from_laser || !wheel_from_base) return MalformedLine{};
  record.wheel_from_base = *wheel_from_base;
  record.base_from_laser = inverse(*wheel_from_base) * *wheel_from_laser;
  for (int i = 0; i < 5; ++i) words.next();  // speeds, safety distances, turn axis
  record.stamps = next_stamps(words);
  return record;
}

CarmenRecord parse_rawlaser(std::string_view keyword, std::uint8_t slot, Words words) {
  LaserRecord record;
  record.kind = LaserRecordKind::kRawLaser;
  record.slot = slot;
  record.scanner = keyword;
  if (!parse_configured_ranges(words, record) || !skip_remissions(words, kStampWords))
    return MalformedLine{};
  record.stamps = next_stamps(words);
  return record;
}

/// LASERn, older than RAWLASERn: readings and stamps only.
CarmenRecord parse_bare_laser(std::string_view keyword, std::uint8_t slot, Words words) {
  LaserRecord record;
  record.kind = LaserRecordKind::kRawLaser;
  record.slot = slot;
  record.scanner = keyword;
  auto range_m = next_ranges(words);
  if (!range_m || words.count_left() == 0) return MalformedLine{};
  record.range_m = std::move(*range_m);
  record.stamps = next_stamps(words);
  return record;
}

CarmenRecord parse_dp_slam_laser(Words words) {
  LaserRecord record;
  record.kind = LaserRecordKind::kDpSlam;
  record.scanner = "Laser";
  auto range_m = next_ranges(words);
  if (!range_m) return MalformedLine{};
  record.range_m = std::move(*range_m);
  return record;
}

CarmenRecord parse_dp_slam_odometry(Words words) {
  const auto wheel_from_base = next_pose(words);
  if (!wheel_from_base) return MalformedLine{};
  return OdometryRecord{*wheel_from_base, {}};
}

CarmenRecord parse_truepos(Words words) {
  const auto map_from_base = next_pose(words);
  const auto wheel_from_base = next_pose(words);
  if (!map_from_base || !wheel_from_base || words.count_left() == 0) return MalformedLine{};
  return OdometryRecord{*wheel_from_base, next_stamps(words), OdometryRecordKind::kTruePos};
}

/// Acceleration, orientation as a quaternion, magnetic field, turn rates about x, y and z.
CarmenRecord parse_imu(Words words) {
  constexpr int kNumbersBeforeYawRate = 12;
  for (int i = 0; i < kNumbersBeforeYawRate; ++i) words.next();
  const auto yaw_rate_radps = next_finite(words);
  if (!yaw_rate_radps || words.count_left() == 0) return MalformedLine{};
  return ImuRecord{*yaw_rate_radps, next_stamps(words)};
}

/// Degrees from NMEA's ddmm.mmmm and its letter; nullopt if it is none.
std::optional<double> next_degrees(Words& words, std::string_view letters, double most_deg) {
  const auto degrees_minutes = next_finite(words);
  const std::string_view letter = words.next();
  if (!degrees_minutes || *degrees_minutes < 0.0 || letter.size() != 1) return std::nullopt;
  const std::size_t side = letters.find(letter.front());
  const double whole = std::floor(*degrees_minutes / 100.0);
  const double degrees = whole + (*degrees_minutes - 100.0 * whole) / 60.0;
  if (side == std::string_view::npos || degrees > most_deg) return std::nullopt;
  return side == 0 ? degrees : -degrees;
}

sensing::GnssQuality quality_of(int indicator) {
  constexpr int kRtk = 4;
  switch (indicator) {
    case 0: return sensing::GnssQuality::no_fix;
    case 2:
    case 5: return sensing::GnssQuality::differential;  // 5: RTK without fixed ambiguities
    case kRtk: return sensing::GnssQuality::rtk;
    default: return sensing::GnssQuality::single;
  }
}

/// GGA has the dilution of precision only: standard deviation of a range, one satellite.
double range_sigma_m(sensing::GnssQuality quality) {
  switch (quality) {
    case sensing::GnssQuality::rtk: return 0.05;
    case sensing::GnssQuality::differential: return 0.7;
    default: return 1.5;
  }
}

/// Receiver, UTC, latitude, longitude, quality, satellites, hdop, 2 heights with 2 references, age.
CarmenRecord parse_nmea_gga(Words words) {
  GnssRecord record;
  record.fix.receiver_id = words.next();
  words.next();  // UTC; the record has a stamp of the logging computer
  const auto latitude_deg = next_degrees(words, "NS", 90.0);
  const auto longitude_deg = next_degrees(words, "EW", 180.0);
  const auto quality = parse_number<int>(words.next());
  const auto satellites = parse_number<int>(words.next());
  const auto hdop = next_finite(words);
  words.next();
  const auto altitude_m = next_finite(words);
  for (int i = 0; i < 3; ++i) words.next();
  if (!latitude_deg || !longitude_deg || !quality || !satellites || !hdop || !altitude_m ||
      words.count_left() == 0)
    return MalformedLine{};
  record.fix.quality = quality_of(*quality);
  record.fix.position = {*latitude_deg, *longitude_deg};
  record.fix.altitude_m = *altitude_m;
  record.fix.hdop = std::clamp(*hdop, 0.0, 100.0);
  record.fix.satellites = *satellites;
  const double sigma_m = range_sigma_m(record.fix.quality) * std::max(0.7, record.fix.hdop);
  record.fix.covariance_m2 = 0.5 * sigma_m * sigma_m * geometry::Matrix2::Identity();
  record.stamps = next_stamps(words);
  return record;
}

/// Compass, heading clockwise from true north [deg], validity.
CarmenRecord parse_nmea_hdt(Words words) {
  constexpr double kSigma_rad = 0.05;  // the sentence has none; of a magnetic compass on a vehicle
  constexpr double kRadPerDeg = std::numbers::pi / 180.0;
  CompassRecord record;
  record.reading.compass_id = words.next();
  const auto heading_deg = next_finite(words);
  const auto valid = parse_number<int>(words.next());
  if (!heading_deg || std::abs(*heading_deg) > 360.0 || !valid || words.count_left() == 0)
    return MalformedLine{};
  if (*valid == 0) return IgnoredLine{};
  record.reading.heading_from_east_rad = geometry::wrap_angle((90.0 - *heading_deg) * kRadPerDeg);
  record.reading.sigma_rad = kSigma_rad;
  record.stamps = next_stamps(words);
  return record;
}

CarmenRecord parse_odom(Words words) {
  const auto wheel_from_base = next_pose(words);
  for (int i = 0; i < 3; ++i) words.next();  // speeds and acceleration
  if (!wheel_from_base || words.count_left() == 0) return MalformedLine{};
  return OdometryRecord{*wheel_from_base, next_stamps(words)};
}

CarmenRecord parse_param(Words words) {
  const std::string_view name = words.next();
  const std::string_view value = words.next();
  if (value.empty()) return MalformedLine{};
  return ParamRecord{name, value};
}

/// The digit after a keyword's name, 1 to 9; nullopt for another keyword.
std::optional<std::uint8_t> numbered(std::string_view keyword, std::string_view name) {
  if (keyword.size() != name.size() + 1 || !keyword.starts_with(name)) return std::nullopt;
  const char digit = keyword.back();
  return digit >= '1' && digit <= '9' ? std::optional(static_cast<std::uint8_t>(digit - '0'))
                                      : std::nullopt;
}

std::optional<std::int64_t> parse_stamp_in_exponent_form(std::string_view text) {
  const auto seconds = parse_number<double>(text);
  if (!seconds || !(std::abs(*seconds) < static_cast<double>(kMaxStampSeconds)))
    return std::nullopt;
  return std::llround(*seconds * 1e9);
}

/// Integer milliseconds, microseconds or nanoseconds since 1970: the number of digits tells which.
std::optional<std::int64_t> parse_stamp_since_epoch(std::string_view text) {
  const auto number = parse_number<std::uint64_t>(text);
  if (!number) return std::nullopt;
  for (const std::uint64_t units_per_s : {1'000ULL, 1'000'000ULL, 1'000'000'000ULL}) {
    const std::uint64_t seconds = *number / units_per_s;
    if (seconds < 500'000'000 || seconds >= 5'000'000'000) continue;
    return static_cast<std::int64_t>(*number * (1'000'000'000ULL / units_per_s));
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::int64_t> parse_stamp_ns(std::string_view text) {
  const std::string_view whole = text;
  const bool is_negative = !text.empty() && text.front() == '-';
  if (is_negative) text.remove_prefix(1);
  if (text.empty() || !(is_digit(text.front()) || text.front() == '.')) return std::nullopt;
  std::int64_t seconds = 0;
  std::size_t at = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) {
    seconds = seconds * 10 + (text[at] - '0');
    if (seconds > kMaxStampSeconds)
      return is_negative ? std::nullopt : parse_stamp_since_epoch(whole);
  }
  std::int64_t fraction_ns = 0;
  if (at < text.size() && text[at] == '.') {
    std::int64_t digit_ns = kNanosecondsPerSecond / 10;
    for (++at; at < text.size() && is_digit(text[at]); ++at, digit_ns /= 10)
      fraction_ns += digit_ns * (text[at] - '0');
  }
  if (at < text.size()) return parse_stamp_in_exponent_form(whole);
  const std::int64_t stamp_ns = seconds * kNanosecondsPerSecond + fraction_ns;
  return is_negative ? -stamp_ns : stamp_ns;
}

std::optional<BeamLayout> layout_of_record(double first_beam_rad, double field_rad, double step_rad,
                                           std::size_t beam_count) {
  constexpr double kFullCircle = 2.0 * std::numbers::pi;
  if (std::abs(first_beam_rad) > kFullCircle || field_rad <= 0.0 || field_rad > kFullCircle + 0.01)
    return std::nullopt;
  const double n = static_cast<double>(beam_count);
  if (step_rad <= 0.0) return BeamLayout{first_beam_rad, field_rad / (n - 1.0)};
  const double half_a_step_rad = 0.5 * step_rad;
  if (std::abs(step_rad * (n - 1.0) - field_rad) < half_a_step_rad)
    return BeamLayout{first_beam_rad, field_rad / (n - 1.0)};
  if (std::abs(step_rad * n - field_rad) < half_a_step_rad)
    return BeamLayout{first_beam_rad, field_rad / n};
  if (step_rad * (n - 1.0) > kFullCircle) return std::nullopt;
  return BeamLayout{first_beam_rad, step_rad};  // only a part of the scanner's field was logged
}

CarmenRecord parse_carmen_line(std::string_view line) {
  Words words(line);
  const std::string_view keyword = words.next();
  if (keyword == "FLASER") return parse_flaser(keyword, Slot::kFront, words);
  if (keyword == "RLASER") return parse_flaser(keyword, Slot::kRear, words);
  if (keyword == "ODOM") return parse_odom(words);
  if (keyword == "PARAM") return parse_param(words);
  if (keyword == "TRUEPOS") return parse_truepos(words);
  if (keyword == "IMU") return parse_imu(words);
  if (keyword == "NMEAGGA") return parse_nmea_gga(words);
  if (keyword == "NMEAHDT") return parse_nmea_hdt(words);
  if (keyword == "Laser") return parse_dp_slam_laser(words);
  if (keyword == "Odometry") return parse_dp_slam_odometry(words);
  if (const auto slot = numbered(keyword, "ROBOTLASER"))
    return parse_robotlaser(keyword, *slot, words);
  if (const auto slot = numbered(keyword, "RAWLASER")) return parse_rawlaser(keyword, *slot, words);
  if (const auto slot = numbered(keyword, "LASER")) return parse_bare_laser(keyword, *slot, words);
  return IgnoredLine{};
}

BeamLayout layout_by_convention(std::size_t beam_count, double field_of_view_rad) {
  const std::size_t steps = beam_count % 2 == 0 ? beam_count : beam_count - 1;
  return {-0.5 * field_of_view_rad, field_of_view_rad / static_cast<double>(steps > 0 ? steps : 1)};
}

}  // namespace slammot::files
