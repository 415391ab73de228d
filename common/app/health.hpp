#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/wire/service.hpp"

namespace slammot::app {

struct HealthQuestion {
  std::vector<std::string> services;   ///< "map_store" or "map-store"; empty: all that are there.
  std::string vehicle_id = "vehicle";  ///< Empty: any.
  std::string instance;                ///< Empty: any.
  std::uint32_t domain_id = 0;
  /// For a service that is not heard; also the time to look for all.
  std::chrono::milliseconds patience{3000};
  std::optional<std::string> dds_config;  ///< Cyclone XML; the environment's when not set.
};

enum class Verdict {
  kGood,      ///< Runs, or stands by for one that leads.
  kDegraded,  ///< Works, but lacks an input or has a fault.
  kDown,      ///< Is not heard, has not started yet, or stops.
};

/// Of one process, or of a service that is not heard.
struct Health {
  wire::ServiceName name;
  std::uint32_t process_number = 0;  ///< 0: not heard.
  bool stands_by = false;
  Verdict verdict = Verdict::kDown;
  std::string text;  ///< One line: "running", "degraded: no slammot/laser_scan for 2.1 s", "no
                     ///< heartbeat within 3 s", ...
};

/// Listens for heartbeats and statuses. Of services that were asked for, waits until each is known
/// and has started, at most `patience`; one that is not heard is down. Of all: listens for
/// `patience`. Sorted by name. Throws dds::StartupError if the bus cannot be joined.
std::vector<Health> check_health(const HealthQuestion& question);

/// The worst one; a standby does not make up for a leader that is down. kDown if there is none.
Verdict verdict_of(const std::vector<Health>& healths);

}  // namespace slammot::app
