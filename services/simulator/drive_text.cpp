#include "services/simulator/drive_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "common/simulation/city_world.hpp"

namespace slammot::simulator {

using geometry::Pose2;
using simulation::SimulatedScan;

namespace {

/// Decimal text with a fixed number of decimals, independent of platform and locale.
void append(std::string& text, double value, int decimals) {
  std::array<char, 64> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::fixed, decimals);
  text.append(digits.data(), end.ptr);
}

void append_all(std::string& text, std::initializer_list<double> values, int decimals,
                char separator) {
  for (const double value : values) {
    append(text, value, decimals);
    text += separator;
  }
}

void append_parameter(std::string& text, std::string_view name, double value, int decimals) {
  text += "PARAM ";
  text += name;
  text += ' ';
  append(text, value, decimals);
  text += '\n';
}

double seconds(std::int64_t stamp_ns) { return static_cast<double>(stamp_ns) * 1e-9; }

void append_ranges(std::string& text, const SimulatedScan& drive) {
  text += std::to_string(drive.scan.range_m.size()) + ' ';
  for (const float range_m : drive.scan.range_m) append_all(text, {range_m}, 2, ' ');
}

/// IPC and logger's stamp.
void append_clocks(std::string& text, std::int64_t stamp_ns) {
  append(text, seconds(stamp_ns), 6);
  text += " sim ";
  append(text, seconds(stamp_ns), 6);
  text += '\n';
}

/// ROBOTLASERn type start field_of_view step max_range accuracy remission_mode n ranges... m
/// laser_pose robot_pose tv rv forward_safety side_safety turn_axis ipc_timestamp host
/// logger_timestamp.
std::string robotlaser_line(const SimulatedScan& drive, const simulation::ScannerConfig& config,
                            std::size_t number) {
  std::string text = "ROBOTLASER" + std::to_string(number) + " 0 ";
  append_all(text,
             {config.first_beam_rad, config.field_of_view_rad, drive.scan.scanner.beam_step_rad}, 6,
             ' ');
  append_all(text, {config.max_range_m, config.resolution_m}, 2, ' ');
  text += "0 ";
  append_ranges(text, drive);
  text += "0 ";
  const Pose2& base = drive.odometry.wheel_from_base;
  const Pose2 laser = base * drive.scan.scanner.base_from_laser;
  append_all(text, {laser.x_m, laser.y_m, laser.heading_rad, base.x_m, base.y_m, base.heading_rad},
             6, ' ');
  append_all(text, {drive.odometry_speed_mps}, 3, ' ');
  append_all(text, {drive.odometry_yaw_rate_radps}, 4, ' ');
  text += "1.0 0.5 0.0 ";
  append_clocks(text, drive.scan.stamp_ns);
  return text;
}

/// FLASER n ranges... x y theta odom_x odom_y odom_theta ipc_timestamp host logger_timestamp. The
/// record has no beam directions: by convention 180 beams, one degree apart, from 90 degrees to the
/// right.
std::string flaser_line(const SimulatedScan& drive) {
  std::string text = "FLASER ";
  append_ranges(text, drive);
  const Pose2& base = drive.odometry.wheel_from_base;
  const Pose2 laser = base * drive.scan.scanner.base_from_laser;
  append_all(text, {laser.x_m, laser.y_m, laser.heading_rad, base.x_m, base.y_m, base.heading_rad},
             6, ' ');
  append_clocks(text, drive.scan.stamp_ns);
  return text;
}

/// Degrees as NMEA's ddmm.mmmmmm and the letter of the side.
void append_degrees(std::string& text, double degrees, std::string_view letters) {
  const double whole = std::floor(std::abs(degrees));
  append(text, 100.0 * whole + 60.0 * (std::abs(degrees) - whole), 6);
  text += ' ';
  text += letters[degrees < 0.0 ? 1 : 0];
  text += ' ';
}

/// NMEAGGA receiver utc latitude N longitude W quality satellites hdop sea_level altitude
/// geo_sea_level geo_sep age ipc_timestamp host logger_timestamp.
std::string gga_line(const sensing::GnssFix& fix) {
  std::string text = "NMEAGGA 1 ";
  append_all(text, {seconds(fix.stamp_ns)}, 3, ' ');
  append_degrees(text, fix.position.latitude_deg, "NS");
  append_degrees(text, fix.position.longitude_deg, "EW");
  text += fix.quality == sensing::GnssQuality::no_fix ? "0 " : "1 ";
  text += std::to_string(fix.satellites) + ' ';
  append_all(text, {fix.hdop < 99.0 ? fix.hdop : 99.0}, 2, ' ');  // NaN without enough satellites
  text += "0 ";
  append_all(text, {fix.altitude_m}, 2, ' ');
  text += "0 0 0 ";
  append_clocks(text, fix.stamp_ns);
  return text;
}

/// IMU accelerations quaternion magnetic_field turn_rates ipc_timestamp host logger_timestamp; only
/// the turn rate about z is simulated.
std::string imu_line(const sensing::TurnRate& reading) {
  std::string text = "IMU 0 0 9.81 1 0 0 0 0 0 0 0 0 ";
  append_all(text, {reading.yaw_rate_radps}, 6, ' ');
  append_clocks(text, reading.stamp_ns);
  return text;
}

/// NMEAHDT compass heading valid ipc_timestamp host logger_timestamp.
std::string hdt_line(const sensing::CompassReading& reading) {
  constexpr double kDegPerRad = 180.0 / std::numbers::pi;
  const double from_north_deg = 90.0 - reading.heading_from_east_rad * kDegPerRad;
  std::string text = "NMEAHDT 1 ";
  append_all(text, {from_north_deg < 0.0 ? from_north_deg + 360.0 : from_north_deg}, 3, ' ');
  text += "1 ";
  append_clocks(text, reading.stamp_ns);
  return text;
}

/// Height and tilt, if it is tilted so that it scans a vertical profile.
void append_tilt(std::string& text, const std::string& name,
                 const simulation::ScannerConfig& mounted) {
  if (!scans_vertically(mounted)) return;
  append_parameter(text, name + "up_offset", mounted.height_m, 3);
  append_parameter(text, name + "roll_offset", mounted.left_up_rad, 6);
  append_parameter(text, name + "pitch_offset", mounted.nose_down_rad, 6);
}

}  // namespace

std::string log_header(const simulation::ScenarioConfig& scenario) {
  std::string text = header_of_log_of(scenario, 0);
  for (std::size_t i = 0; i < scenario.more_scanners.size(); ++i) {
    const simulation::ScannerConfig& mounted = scenario.more_scanners[i];
    const std::string name = "robot_laser" + std::to_string(i + 2) + "_";
    append_parameter(text, name + "offset", mounted.ahead_m, 3);
    append_parameter(text, name + "side_offset", mounted.left_m, 3);
    append_parameter(text, name + "angular_offset", mounted.heading_rad, 6);
    append_tilt(text, name, mounted);
  }
  return text;
}

std::string header_of_log_of(const simulation::ScenarioConfig& scenario, std::size_t scanner) {
  const simulation::ScannerConfig& mounted = scenario.scanner_at(scanner);
  std::string text = "# CARMEN Logfile\n";
  append_parameter(text, "robot_frontlaser_offset", mounted.ahead_m, 3);
  if (mounted.left_m != 0.0)
    append_parameter(text, "robot_frontlaser_side_offset", mounted.left_m, 3);
  if (mounted.heading_rad != 0.0)
    append_parameter(text, "robot_frontlaser_angular_offset", mounted.heading_rad, 6);
  append_tilt(text, "robot_frontlaser_", mounted);
  append_parameter(text, "robot_width", scenario.route.width_m, 1);
  append_parameter(text, "robot_length", scenario.route.length_m, 1);
  return text;
}

std::string log_line(const SimulatedScan& drive, const simulation::ScenarioConfig& scenario) {
  std::string text;
  for (const sensing::TurnRate& reading : drive.turn_rates) text += imu_line(reading);
  for (const sensing::GnssFix& fix : drive.gnss) text += gga_line(fix);
  for (const sensing::CompassReading& reading : drive.compass) text += hdt_line(reading);
  return text +=
         scenario.more_scanners.empty()
             ? line_of_log_of_its_scanner(drive, scenario)
             : robotlaser_line(drive, scenario.scanner_at(drive.scanner), drive.scanner + 1);
}

std::string line_of_log_of_its_scanner(const SimulatedScan& drive,
                                       const simulation::ScenarioConfig& scenario) {
  const bool flaser = scenario.log_record == simulation::LogRecord::flaser;
  return flaser ? flaser_line(drive)
                : robotlaser_line(drive, scenario.scanner_at(drive.scanner), 1);
}

std::string tum_line(const SimulatedScan& drive) {
  std::string text;
  append_all(text,
             {seconds(drive.scan.stamp_ns), drive.world_from_base.x_m, drive.world_from_base.y_m},
             6, ' ');
  text += "0 0 0 ";
  append_all(text, {std::sin(0.5 * drive.world_from_base.heading_rad)}, 9, ' ');
  append(text, std::cos(0.5 * drive.world_from_base.heading_rad), 9);
  return text + '\n';
}

std::string object_lines(const SimulatedScan& drive) {
  std::string text;
  for (const simulation::ObjectTruth& object : drive.objects) {
    append_all(text, {seconds(drive.scan.stamp_ns)}, 6, ',');
    text += std::to_string(object.id) + ',';
    text += name(object.kind);
    text += ',';
    append_all(text, {object.world_from_object.x_m, object.world_from_object.y_m}, 3, ',');
    append_all(text, {object.world_from_object.heading_rad}, 5, ',');
    append_all(text, {object.speed_mps}, 3, ',');
    append_all(text, {object.size.length_m, object.size.width_m}, 2, ',');
    text += std::to_string(object.points) + ',';
    append(text, object.range_m, 2);
    text += '\n';
  }
  return text;
}

std::string wall_lines(const simulation::Outline& stationary_in_world) {
  std::string text = "ax,ay,bx,by,class\n";
  for (const simulation::Segment& segment : simulation::true_segments(stationary_in_world)) {
    append_all(text, {segment.a.x(), segment.a.y(), segment.b.x(), segment.b.y()}, 3, ',');
    text += std::to_string(static_cast<int>(segment.material)) + '\n';
  }
  return text;
}

std::string hits_header() { return "timestamp,scanner,hits\n"; }

std::string hits_line(const SimulatedScan& drive) {
  std::string text;
  append_all(text, {seconds(drive.scan.stamp_ns)}, 6, ',');
  text += drive.scan.scanner.scanner_id + ',';
  const auto& hits = drive.hits;
  for (auto begin = hits.begin(); begin != hits.end();) {
    const auto end = std::find_if(begin, hits.end(), [&](int hit) { return hit != *begin; });
    if (begin != hits.begin()) text += ' ';
    text += std::to_string(*begin) + '*' + std::to_string(end - begin);
    begin = end;
  }
  return text + '\n';
}

std::string gnss_header() {
  return "timestamp,receiver,quality,latitude_deg,longitude_deg,altitude_m,east_variance_m2,north_"
         "variance_m2,covariance_m2,hdop,satellites\n";
}

std::string gnss_line(const sensing::GnssFix& fix) {
  std::string text;
  append_all(text, {seconds(fix.stamp_ns)}, 6, ',');
  text += fix.receiver_id + ',' + std::to_string(static_cast<int>(fix.quality)) + ',';
  append_all(text, {fix.position.latitude_deg, fix.position.longitude_deg}, 9, ',');
  append_all(
      text,
      {fix.altitude_m, fix.covariance_m2(0, 0), fix.covariance_m2(1, 1), fix.covariance_m2(0, 1)},
      3, ',');
  append_all(text, {fix.hdop}, 2, ',');
  return text + std::to_string(fix.satellites) + '\n';
}

std::string compass_header() { return "timestamp,compass,heading_from_east_rad,sigma_rad\n"; }

std::string compass_line(const sensing::CompassReading& reading) {
  std::string text;
  append_all(text, {seconds(reading.stamp_ns)}, 6, ',');
  text += reading.compass_id + ',';
  append_all(text, {reading.heading_from_east_rad}, 5, ',');
  append(text, reading.sigma_rad, 5);
  return text + '\n';
}

std::string objects_header() {
  return "timestamp,id,class,x,y,yaw,speed,length,width,points,range\n";
}

}  // namespace slammot::simulator
