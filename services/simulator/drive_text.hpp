#pragma once

#include <string>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

// A drive as text: whole lines, the same on every platform and in every locale.

/// First lines of a CARMEN log.
std::string log_header(const simulation::ScenarioConfig& scenario);
/// ROBOTLASER1 or FLASER, as the scenario says; pose by odometry.
std::string log_line(const simulation::SimulatedScan& drive, const simulation::ScenarioConfig& scenario);

/// "stamp x y 0 0 0 qz qw": the vehicle's centre in the world.
std::string tum_line(const simulation::SimulatedScan& drive);

std::string objects_header();
/// One line for each moving object that the scan hit.
std::string object_lines(const simulation::SimulatedScan& drive);

/// Header and one line for each segment of what stands still.
std::string wall_lines(const simulation::Outline& stationary_in_world);

}  // namespace slammot::simulator
