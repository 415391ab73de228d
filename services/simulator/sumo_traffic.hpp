#pragma once

#include <filesystem>
#include <vector>

#include "common/files/result.hpp"
#include "common/simulation/script.hpp"

namespace slammot::simulator {

/// Everybody in a file that Eclipse SUMO wrote with --fcd-output (plain XML, no geographic
/// coordinates). Its places are of front bumpers and its angles in degrees, clockwise from north;
/// the vehicle type's name tells the class. Times count from the file's first one. The fault names
/// the line.
files::Result<std::vector<simulation::RecordedObject>> read_sumo_traffic(
    const std::filesystem::path& file);

}  // namespace slammot::simulator
