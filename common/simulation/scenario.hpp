#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/simulation/office_plan.hpp"
#include "common/simulation/robot.hpp"
#include "common/simulation/scanner_model.hpp"
#include "common/simulation/street_plan.hpp"
#include "common/simulation/traffic.hpp"
#include "common/simulation/vehicle_model.hpp"
#include "common/simulation/walkers.hpp"

namespace slammot::simulation {

enum class Place { city, office };
/// Which CARMEN record a log of the drive has.
enum class LogRecord { robotlaser1, flaser };

/// Everything a simulated drive depends on. The same scenario gives the same bytes.
struct ScenarioConfig {
  std::string name;
  std::string description;            ///< One line, for people.
  std::uint64_t seed = 1;
  double duration_s = 80.0;
  double start_stamp_s = 21.0;        ///< Clock at the first scan; a log's clock does not start at 0 either.
  double warm_up_s = 10.0;            ///< The world moves this long before the vehicle sets out, unrecorded.
  Place place = Place::city;
  WalkersConfig walkers;
  CityConfig city;                    ///< These three of a city,
  TrafficConfig traffic;
  RouteConfig route;
  OfficeConfig office;                ///< these three of an office.
  RobotConfig robot;
  std::vector<OfficeCorner> robot_way;
  SuspensionConfig suspension;
  OdometryConfig odometry;
  ScannerConfig scanner;
  std::string profile = "urban";      ///< Settings that suit the drive.
  LogRecord log_record = LogRecord::robotlaser1;
};

/// Shipped scenarios, in the order in which they are listed.
std::vector<std::string> scenario_names();

/// A shipped scenario with its own seed, or with another one; none where there is no such name.
std::optional<ScenarioConfig> shipped_scenario(std::string_view name, std::optional<std::uint64_t> seed = std::nullopt);

}  // namespace slammot::simulation
