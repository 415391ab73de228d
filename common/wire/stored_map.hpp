#pragma once

#include <string_view>

#include "common/flow/stored_map.hpp"
#include "common/wire/decoded.hpp"
#include "idl/mapping.h"

namespace slammot::wire {

slammot_StoredMap encode(std::string_view vehicle_id, const flow::StoredMap& map);
Decoded<flow::StoredMap> decode(const slammot_StoredMap& sample);

}  // namespace slammot::wire
