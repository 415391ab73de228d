#pragma once

#include "common/config/fields.hpp"
#include "services/map_store/map_store_config.hpp"

namespace slammot::map_store {

/// Settings of the map store, as in message MapStore.
const config::FieldTable<MapStoreConfig>& map_store_fields();

}  // namespace slammot::map_store
