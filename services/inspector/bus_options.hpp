#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace slammot::inspector {

/// Exit codes of the commands of this folder.
inline constexpr int kExitDone = 0;
inline constexpr int kExitFault = 1;  ///< A fault was found, or the bus cannot be joined.

/// The bus to look at.
struct BusOptions {
  std::uint32_t domain_id = 0;
  std::chrono::milliseconds patience{1500};  ///< Time to discover who is there.
  std::optional<std::string> dds_config;     ///< Cyclone XML; the environment's when not set.
};

void add_bus_options(CLI::App& command, BusOptions& options);

}  // namespace slammot::inspector
