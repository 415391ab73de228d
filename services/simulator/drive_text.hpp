#pragma once

#include <string>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

// A drive as text: whole lines, the same on every platform and in every locale.

/// First lines of a CARMEN log of all scanners: mountings as PARAM robot_frontlaser_* and, of the
/// scanner N from 2 on, robot_laserN_*.
std::string log_header(const simulation::ScenarioConfig& scenario);
/// ROBOTLASER1 or FLASER, as the scenario says; ROBOTLASERn where there are several scanners. Pose
/// by odometry.
std::string log_line(const simulation::SimulatedScan& drive,
                     const simulation::ScenarioConfig& scenario);

/// The same of a log that has one of several scanners only, as if it were the vehicle's first one.
std::string header_of_log_of(const simulation::ScenarioConfig& scenario, std::size_t scanner);
std::string line_of_log_of_its_scanner(const simulation::SimulatedScan& drive,
                                       const simulation::ScenarioConfig& scenario);

/// "stamp x y 0 0 0 qz qw": the vehicle's centre in the world.
std::string tum_line(const simulation::SimulatedScan& drive);

std::string objects_header();
/// One line for each moving object that the scan hit.
std::string object_lines(const simulation::SimulatedScan& drive);

std::string hits_header();
/// What each beam hit, runs of the same together: "timestamp,scanner,hit*beams hit*beams ...".
std::string hits_line(const simulation::SimulatedScan& drive);

std::string gnss_header();
std::string gnss_line(const sensing::GnssFix& fix);
std::string compass_header();
std::string compass_line(const sensing::CompassReading& reading);

/// Header and one line for each segment of what stands still.
std::string wall_lines(const simulation::Outline& stationary_in_world);

}  // namespace slammot::simulator
