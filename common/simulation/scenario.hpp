#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/simulation/compass.hpp"
#include "common/simulation/gnss_receiver.hpp"
#include "common/simulation/gyro.hpp"
#include "common/simulation/office_plan.hpp"
#include "common/simulation/robot.hpp"
#include "common/simulation/scanner_model.hpp"
#include "common/simulation/script.hpp"
#include "common/simulation/street_plan.hpp"
#include "common/simulation/traffic.hpp"
#include "common/simulation/vehicle_model.hpp"
#include "common/simulation/walkers.hpp"

namespace slammot::simulation {

enum class Place { city, office, script };
/// CARMEN record type of a drive's log.
enum class LogRecord { robotlaser1, flaser };

/// All parameters of a simulated drive. The same scenario gives bitwise the same result.
struct ScenarioConfig {
  std::string name;
  std::string description;  ///< One line, for people.
  std::uint64_t seed = 1;
  double duration_s = 80.0;
  double start_stamp_s = 21.0;  ///< Clock at the first scan; a log's clock does not start at 0
                                ///< either.
  double warm_up_s = 10.0;      ///< Unrecorded simulation time before the vehicle starts.
  Place place = Place::city;
  WalkersConfig walkers;
  CityConfig city;  ///< These three of a city,
  TrafficConfig traffic;
  RouteConfig route;
  OfficeConfig office;  ///< these three of an office.
  RobotConfig robot;
  std::vector<OfficeCorner> robot_way;
  ScriptConfig script;   ///< All of a scripted scene.
  std::string sumo_fcd;  ///< File that the script's recorded objects come from; as seen from the
                         ///< scenario's folder.
  std::string sumo_vehicle;  ///< Which of them carries the scanner; empty: the script's own
                             ///< vehicle.
  int ride = 0;              ///< Of a script's vehicles with scanners: which one; 0 is the vehicle.
  std::vector<HeightAt> terrain;  ///< Empty: level.
  SuspensionConfig suspension;
  OdometryConfig odometry;
  ScannerConfig scanner;  ///< The first scanner; its scans determine the time steps.
  std::vector<ScannerConfig> more_scanners;
  GnssConfig gnss;
  CompassConfig compass;
  ImuConfig imu;
  std::string profile = "urban";  ///< Settings that suit the drive.
  LogRecord log_record = LogRecord::robotlaser1;

  /// Of any of its scanners; 0 is the first.
  const ScannerConfig& scanner_at(std::size_t index) const {
    return index == 0 ? scanner : more_scanners[index - 1];
  }
};

}  // namespace slammot::simulation
