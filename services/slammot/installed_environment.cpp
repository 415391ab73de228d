#include "services/slammot/installed_environment.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace slammot {
namespace {

constexpr std::string_view kInstalledProgram = "/usr/bin/slammot";
constexpr const char* kFileOfServices = "/etc/slammot/slammot.env";

std::string_view without_quotes(std::string_view value) {
  const bool is_quoted = value.size() >= 2 && (value.front() == '"' || value.front() == '\'') &&
                         value.front() == value.back();
  return is_quoted ? value.substr(1, value.size() - 2) : value;
}

bool is_of_the_bus(std::string_view name) {
  return name.starts_with("SLAMMOT_") || name == "CYCLONEDDS_URI";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> bus_environment(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> environment;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos || !is_of_the_bus(line.substr(0, equals))) continue;
    environment.emplace_back(line.substr(0, equals),
                             without_quotes(std::string_view(line).substr(equals + 1)));
  }
  return environment;
}

void take_environment_of_services(const std::filesystem::path& program) {
  constexpr int kKeeps = 0;  // what is set already
  if (program != kInstalledProgram) return;
  std::ostringstream text;
  text << std::ifstream(kFileOfServices).rdbuf();
  for (const auto& [name, value] : bus_environment(text.str()))
    ::setenv(name.c_str(), value.c_str(), kKeeps);
}

}  // namespace slammot
