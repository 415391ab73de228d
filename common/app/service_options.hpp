#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/config/overlay.hpp"

namespace CLI {
class App;
}

namespace slammot::app {

inline constexpr std::size_t kLongestName = 32;  ///< Of vehicles, scanners and instances on the
                                                 ///< bus.

/// Command-line options common to all services.
struct ServiceOptions {
  std::string vehicle_id = "vehicle";
  std::uint32_t domain_id = 0;
  std::string instance = "main";
  std::filesystem::path state_dir = "slammot-state";  ///< State that survives a crash.
  std::string profile;                                ///< Name or path; empty: none.
  std::vector<std::string> config_files;              ///< Over the profile, the last one wins.
  bool check_config = false;
  bool print_config = false;
  std::optional<std::string> dds_config;  ///< Cyclone XML; the environment's when not set. Not on
                                          ///< the command line.
};

/// Whose a service's state is.
enum class StateOf {
  kVehicle,   ///< Of the instance that leads; a standby of any name takes it over.
  kInstance,  ///< Each instance has its own.
};

/// Path of a file in the state directory, such as localization-vehicle.checkpoint. `ending` begins
/// with a dot.
std::filesystem::path state_path(const ServiceOptions& options, const std::string& service,
                                 StateOf of, const std::string& ending);

/// Adds --domain, also of the environment; `domain_id` must outlive the parsing.
void add_domain_option(CLI::App& command_line, std::uint32_t& domain_id);

/// Adds --speed of a recorded or simulated drive, which takes what Pace takes; `speed` must outlive
/// the parsing.
void add_speed_option(CLI::App& command_line, std::string& speed, const std::string& meaning);

/// Adds the options to the command line. `options` must outlive the parsing.
void add_service_options(CLI::App& command_line, ServiceOptions& options);

/// Overlays profile and files onto the stages, in this order. Returns the reason of a failure in
/// one line.
std::optional<std::string> load_config(const ServiceOptions& options,
                                       std::span<const config::BoundStage> stages);

}  // namespace slammot::app
