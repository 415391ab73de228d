#pragma once

#include "common/config/fields.hpp"
#include "services/map_store/map_store_config.hpp"

namespace slammot::map_store {

/// The settings of the map store as message MapStore has them.
const config::FieldTable<MapStoreConfig>& map_store_fields();

}  // namespace slammot::map_store
