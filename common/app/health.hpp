#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace slammot::app {

struct HealthQuestion {
  std::string service;  ///< "map_store" or "map-store".
  std::string vehicle_id = "vehicle";
  std::string instance;  ///< Empty: any.
  std::uint32_t domain_id = 0;
  std::chrono::milliseconds patience{3000};
  std::optional<std::string> dds_config;  ///< Cyclone XML; the environment's when not set.
};

struct Health {
  bool is_healthy = false;
  std::string text;  ///< One line: "running", "degraded: no slammot/laser_scan for 2.1 s", "no
                     ///< heartbeat within 3 s", ...
};

/// Listens for a service's heartbeat and status. A service is healthy if it sends heartbeats and
/// has started. A service that lacks an input is healthy and reports the input. Throws
/// dds::StartupError if the bus cannot be joined.
Health check_health(const HealthQuestion& question);

}  // namespace slammot::app
