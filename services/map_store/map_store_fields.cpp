#include "services/map_store/map_store_fields.hpp"

namespace slammot::map_store {

const config::FieldTable<MapStoreConfig>& map_store_fields() {
  using C = MapStoreConfig;
  using config::Range;
  static const config::FieldTable<C> table = {
      {"busy_timeout_s", &C::busy_timeout_s, "How long to wait for another program that has the database locked.",
       Range{0.0, 60.0}},
      {"max_database_mb", &C::max_database_mb, "Largest size of the database; 0: as large as the disk.", Range{0, 1'000'000}},
      {"retry_after_s", &C::retry_after_s, "After a submap could not be written.", Range{0.05, 3600.0}},
      {"max_unwritten_submaps", &C::max_unwritten_submaps, "Kept in memory while the database takes none.", Range{1, 10'000}},
  };
  return table;
}

}  // namespace slammot::map_store
