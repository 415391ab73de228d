#pragma once

#include <string>
#include <string_view>

namespace slammot::dds {

/// Cyclone configuration (XML) for services when the user gives none: the interface and the discovery that Cyclone
/// chooses itself, room for 120 participants on one host, and a dead neighbour given up after 3 s instead of 10 s.
std::string default_config();

/// Cyclone configuration (XML) for a closed bus on this machine: loopback only, unicast. Participants see each other
/// only if their tags are the same, so that two runs in one domain do not meet. `tag`: at most 200 characters out of
/// letters, digits, '-', '_' and '.'; throws std::invalid_argument otherwise.
std::string loopback_config(std::string_view tag);

/// What participants use: default_config(), overlaid by the environment's CYCLONEDDS_URI (XML or file://PATH) if set.
std::string config_from_environment();

}  // namespace slammot::dds
