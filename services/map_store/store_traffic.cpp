#include "services/map_store/sqlite_statement.hpp"
#include "services/map_store/store.hpp"
#include "services/map_store/traffic_record.hpp"

namespace slammot::map_store {

bool Store::add_traffic(std::string_view vehicle_id, flow::MapId map_id, flow::SubmapId submap_id,
                        std::vector<traffic::FreeStream> streams) {
  last_fault_.clear();
  const auto map = static_cast<std::int64_t>(map_id.value);
  try {
    Statement known(database_.get(),
                    "SELECT record FROM traffic WHERE vehicle_id = ? AND map_id = ? AND "
                    "submap_id = ?");
    known << vehicle_id << map << std::int64_t{submap_id.value};
    if (known.step()) {
      if (const auto stored = from_traffic_blob(known.bytes(0)))
        streams.insert(streams.end(), stored->begin(), stored->end());
      known.step();  // ends the read
    }
    const std::string blob = to_traffic_blob(streams);
    Statement insert(database_.get(), "INSERT OR REPLACE INTO traffic VALUES (?, ?, ?, ?)");
    insert << vehicle_id << map << std::int64_t{submap_id.value};
    insert.bind_blob(blob).step();
    return true;
  } catch (const SqliteError& error) {
    last_fault_ = error.what();
    return false;
  }
}

std::vector<Store::StoredTraffic> Store::traffic(std::string_view vehicle_id, flow::MapId map_id) {
  last_fault_.clear();
  std::vector<StoredTraffic> all;
  try {
    Statement query(database_.get(),
                    "SELECT submap_id, record FROM traffic WHERE vehicle_id = ? AND map_id = ? "
                    "ORDER BY submap_id");
    query << vehicle_id << static_cast<std::int64_t>(map_id.value);
    while (query.step())
      all.push_back(
          {{static_cast<std::uint32_t>(query.integer(0))}, from_traffic_blob(query.bytes(1))});
  } catch (const SqliteError& error) { last_fault_ = error.what(); }
  return all;
}

}  // namespace slammot::map_store
