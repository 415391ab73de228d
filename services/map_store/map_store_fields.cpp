#include "services/map_store/map_store_fields.hpp"

namespace slammot::map_store {

const config::FieldTable<MapStoreConfig>& map_store_fields() {
  using C = MapStoreConfig;
  using config::Range;
  static const config::FieldTable<C> table =
      config::in_group<C>(config::Group::operation,
                          {
                              {"busy_timeout_s",
                               &C::busy_timeout_s,
                               "How long to wait for another program that has the database locked.",
                               Range{0.0, 60.0},
                               {"A backup in progress delays submaps by another try.",
                                "A locked database blocks the service."}},
                              {"max_database_mb",
                               &C::max_database_mb,
                               "Largest size of the database; 0: as large as the disk.",
                               Range{0, 1'000'000},
                               {"Submaps of a long drive are not kept.", "The disk fills up."}},
                              {"retry_after_s",
                               &C::retry_after_s,
                               "After a submap could not be written.",
                               Range{0.05, 3600.0},
                               {"Tries load a disk that is busy already.",
                                "Submaps wait in memory and are lost in a crash."}},
                          });
  return table;
}

}  // namespace slammot::map_store
