#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace slammot {

/// Lines NAME=VALUE of systemd's environment files (systemd.exec(5)) for the bus and the vehicle:
/// SLAMMOT_... and CYCLONEDDS_URI. Comments, other names and what is no such line are left out;
/// quotes around a value are removed.
std::vector<std::pair<std::string, std::string>> bus_environment(std::string_view text);

/// An installed command meets the services of its computer: takes what their environment file sets
/// and the caller's environment does not. A file that cannot be read changes nothing.
void take_environment_of_services(const std::filesystem::path& program);

}  // namespace slammot
