#pragma once

#include <filesystem>
#include <vector>

#include "common/files/result.hpp"
#include "common/simulation/script.hpp"

namespace slammot::simulator {

/// Reads all objects in a file written by Eclipse SUMO with --fcd-output (plain XML, no geographic
/// coordinates). SUMO positions are those of front bumpers; its angles are in degrees, clockwise
/// from north. The name of the vehicle type gives the class. Times are relative to the first one in
/// the file. A fault names the line.
files::Result<std::vector<simulation::RecordedObject>> read_sumo_traffic(
    const std::filesystem::path& file);

}  // namespace slammot::simulator
