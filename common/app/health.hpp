#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace slammot::app {

struct HealthQuestion {
  std::string service;                 ///< "map_store" or "map-store".
  std::string vehicle_id = "vehicle";
  std::string instance;                ///< Empty: any.
  std::uint32_t domain_id = 0;
  std::chrono::milliseconds patience{3000};
  std::optional<std::string> dds_config;  ///< Cyclone XML; the environment's when not set.
};

struct Health {
  bool is_healthy = false;
  std::string text;  ///< One line: "running", "degraded: no slammot/laser_scan for 2.1 s", "no heartbeat within 3 s", ...
};

/// Listens for a service's heartbeat and status. Healthy is what beats and is past its start; a service that misses an
/// input is healthy itself, and says what it misses. Throws dds::StartupError when the bus cannot be joined.
Health check_health(const HealthQuestion& question);

}  // namespace slammot::app
