#include "services/map_store/map_store_fields.hpp"

namespace slammot::map_store {

const config::FieldTable<MapStoreConfig>& map_store_fields() {
  using C = MapStoreConfig;
  using config::Range;
  static const config::FieldTable<C> table =
      config::in_group<C>(config::Group::operation,
                          {
                              {"max_database_mb",
                               &C::max_database_mb,
                               "Greatest size of the database; 0: limited by the disk only.",
                               Range{0, 1'000'000},
                               {"Submaps of a long drive are not stored.", "The disk fills up."}},
                          });
  return table;
}

}  // namespace slammot::map_store
