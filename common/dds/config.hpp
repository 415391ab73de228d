#pragma once

#include <string>
#include <string_view>

namespace slammot::dds {

/// Default Cyclone configuration (XML) of services: automatic interface and discovery, room for 120
/// participants on one host, and a lost neighbour is dropped after 3 s instead of 10 s.
std::string default_config();

/// Cyclone configuration (XML) for a closed bus on this machine: loopback only, unicast. Only
/// participants with the same tag see each other, so that two runs in one domain are separate.
/// `tag`: at most 200 characters of letters, digits, '-', '_' and '.'; throws std::invalid_argument
/// otherwise.
std::string loopback_config(std::string_view tag);

/// Effective configuration: default_config(), overlaid by the environment's CYCLONEDDS_URI (XML or
/// file://PATH) if set.
std::string config_from_environment();

}  // namespace slammot::dds
