#include "common/app/service_options.hpp"

#include <cstdlib>

#include <CLI/CLI.hpp>

#include "common/app/bus_option.hpp"
#include "common/app/pace.hpp"
#include "common/config/profiles.hpp"
#include "common/dds/config.hpp"

namespace slammot::app {
namespace {

/// Names become keys on the bus, parts of frame names and of file names.
std::string fault_of_name(const std::string& name) {
  const bool is_plain =
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.") ==
      std::string::npos;
  if (name.empty() || name.size() > kLongestName || !is_plain)
    return "'" + name + "' is not 1 to 32 letters, digits, '_', '-', '.'";
  return {};
}

std::string fault_of_speed(const std::string& speed) {
  return Pace::parse(speed) ? std::string() : "'" + speed + "' is not " + Pace::kExpected;
}

constexpr const char* kBusHelp =
    "Name of a closed bus on this machine: loopback only, apart from all others";

}  // namespace

std::filesystem::path state_path(const ServiceOptions& options, const std::string& service,
                                 StateOf of, const std::string& ending) {
  const std::string instance = of == StateOf::kInstance ? "-" + options.instance : "";
  return options.state_dir / (service + "-" + options.vehicle_id + instance + ending);
}

void add_bus_option(CLI::App& command_line, std::string& bus) {
  command_line.add_option("--bus", bus, kBusHelp)
      ->envname("SLAMMOT_BUS")
      ->check(CLI::Validator(fault_of_name, "NAME"));
}

void add_domain_option(CLI::App& command_line, std::uint32_t& domain_id) {
  constexpr std::uint32_t kHighestDomain = 230;  // the highest whose ports exist
  command_line.add_option("--domain", domain_id, "DDS domain")
      ->envname("SLAMMOT_DOMAIN")
      ->capture_default_str()
      ->check(CLI::Range(std::uint32_t{0}, kHighestDomain));
  command_line
      .add_option_function<std::string>(
          "--bus",
          [](const std::string& name) {
            ::setenv("CYCLONEDDS_URI", dds::loopback_config(name).c_str(), 1);
          },
          kBusHelp)
      ->envname("SLAMMOT_BUS")
      ->check(CLI::Validator(fault_of_name, "NAME"));
}

void add_speed_option(CLI::App& command_line, std::string& speed, const std::string& meaning) {
  command_line.add_option("--speed", speed, meaning)
      ->capture_default_str()
      ->check(CLI::Validator(fault_of_speed, "X|max"));
}

void add_service_options(CLI::App& command_line, ServiceOptions& options) {
  const CLI::Validator is_name(fault_of_name, "NAME");
  command_line
      .add_option("--vehicle", options.vehicle_id,
                  "Vehicle whose data is processed; key of every sample")
      ->envname("SLAMMOT_VEHICLE")
      ->capture_default_str()
      ->check(is_name);
  add_domain_option(command_line, options.domain_id);
  command_line
      .add_option("--instance", options.instance,
                  "Name of this process, if several of the same service and vehicle run")
      ->capture_default_str()
      ->check(is_name);
  command_line
      .add_option("--state-dir", options.state_dir, "Folder for state that survives a crash")
      ->capture_default_str();
  command_line.add_option("--profile", options.profile, "Name of a shipped profile, or a file");
  command_line.add_option("--config", options.config_files,
                          "Settings in protobuf text format that override the profile's");
  command_line.add_flag("--check-config", options.check_config,
                        "Check profile and settings, then exit");
  command_line.add_flag("--print-config", options.print_config,
                        "Print the effective settings in the format of --config, then exit");
}

std::optional<std::string> load_config(const ServiceOptions& options,
                                       std::span<const config::BoundStage> stages) {
  std::vector<std::filesystem::path> files(options.config_files.begin(),
                                           options.config_files.end());
  if (!options.profile.empty()) {
    const auto profile = config::find_profile(options.profile);
    if (!profile) return config::unknown_profile(options.profile);
    files.insert(files.begin(), *profile);
  }
  for (const std::filesystem::path& file : files) {
    if (const auto fault = config::overlay_file(file, stages)) return fault->text();
  }
  return std::nullopt;
}

}  // namespace slammot::app
