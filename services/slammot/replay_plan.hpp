#pragma once

#include <optional>
#include <string>
#include <vector>

namespace slammot {

/// The topics by which a service is replayed.
struct ReplayPlan {
  std::string service;               ///< "map_store"
  std::string trigger;               ///< Input that is answered by the first of the outputs.
  std::vector<std::string> inputs;   ///< With the trigger.
  std::vector<std::string> outputs;  ///< That follow from the inputs alone: no heartbeats or
                                     ///< status.

  bool is_input(const std::string& topic) const;
  bool is_output(const std::string& topic) const;
};

/// None for a service that cannot be replayed. "map-store" is "map_store".
std::optional<ReplayPlan> replay_plan(std::string service);

/// Names of the services that can be replayed, for a message: "detection, localization, ...".
std::string replayed_services();

}  // namespace slammot
