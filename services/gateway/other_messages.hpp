#pragma once

#include <string>

#include "common/sensing/aids.hpp"
#include "foxglove.pb.h"

namespace slammot::gateway {

foxglove::LocationFix fix_message(const sensing::GnssFix& fix);

/// A warning of a service: "tracking: no slammot/segmented_scan for 2.1 s".
foxglove::Log log_message(std::int64_t stamp_ns, const std::string& warning);

}  // namespace slammot::gateway
