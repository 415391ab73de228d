#pragma once

#include "common/config/fields.hpp"
#include "services/localization/local_map.hpp"

namespace slammot::localization {

config::FieldTable<LocalMapConfig> map_fields();

}  // namespace slammot::localization
