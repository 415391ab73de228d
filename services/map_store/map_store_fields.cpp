#include "services/map_store/map_store_fields.hpp"

namespace slammot::map_store {

const config::FieldTable<MapStoreConfig>& map_store_fields() {
  using C = MapStoreConfig;
  using config::Range;
  static const config::FieldTable<C> table = config::in_group<C>(
      config::Group::operation,
      {
          {"busy_timeout_s",
           &C::busy_timeout_s,
           "Longest wait for a database that another program has locked.",
           Range{0.0, 60.0},
           {"A backup in progress delays submaps by another attempt.",
            "A locked database blocks the service."}},
          {"max_database_mb",
           &C::max_database_mb,
           "Greatest size of the database; 0: limited by the disk only.",
           Range{0, 1'000'000},
           {"Submaps of a long drive are not stored.", "The disk fills up."}},
          {"retry_after_s",
           &C::retry_after_s,
           "Interval of attempts to write a submap after a failure.",
           Range{0.05, 3600.0},
           {"Attempts load a busy disk.", "Submaps wait in memory and are lost in a crash."}},
      });
  return table;
}

}  // namespace slammot::map_store
