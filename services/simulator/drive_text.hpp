#pragma once

#include <string>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

// Text formats of a drive. All functions return whole lines, independent of platform and locale.

/// First lines of a CARMEN log of all scanners: mountings as PARAM robot_frontlaser_*, and
/// robot_laserN_* of scanner N from 2 on.
std::string log_header(const simulation::ScenarioConfig& scenario);
/// Lines IMU, NMEAGGA and NMEAHDT of the readings up to the scan, then
/// ROBOTLASER1 or FLASER, as the scenario selects; ROBOTLASERn with several scanners. The pose is
/// odometry.
std::string log_line(const simulation::SimulatedScan& drive,
                     const simulation::ScenarioConfig& scenario);

/// Header and lines of a log of one of several scanners, as if it were the vehicle's first one.
std::string header_of_log_of(const simulation::ScenarioConfig& scenario, std::size_t scanner);
std::string line_of_log_of_its_scanner(const simulation::SimulatedScan& drive,
                                       const simulation::ScenarioConfig& scenario);

/// "stamp x y 0 0 0 qz qw": the vehicle's centre in world.
std::string tum_line(const simulation::SimulatedScan& drive);

std::string objects_header();
/// One line for each of the objects.
std::string object_lines(const simulation::SimulatedScan& drive);

std::string hits_header();
/// Run-length encoded hits of the beams: "timestamp,scanner,hit*beams hit*beams ...".
std::string hits_line(const simulation::SimulatedScan& drive);

std::string gnss_header();
std::string gnss_line(const sensing::GnssFix& fix);
std::string compass_header();
std::string compass_line(const sensing::CompassReading& reading);

/// Header and one line for each stationary segment.
std::string wall_lines(const simulation::Outline& stationary_in_world);

}  // namespace slammot::simulator
