#include "services/map_store/store.hpp"

#include <cmath>

#include "services/map_store/sqlite_statement.hpp"
#include "services/map_store/submap_record.hpp"

namespace slammot::map_store {
namespace {

constexpr std::int64_t kSchemaVersion = 2;
constexpr std::int64_t kPageBytes = 4096;

constexpr std::string_view kSchema =
    "CREATE TABLE IF NOT EXISTS submap ("
    " vehicle_id TEXT NOT NULL, map_id INTEGER NOT NULL, submap_id INTEGER NOT NULL,"
    " first_stamp_ns INTEGER NOT NULL, last_stamp_ns INTEGER NOT NULL, record BLOB NOT NULL,"
    " PRIMARY KEY (vehicle_id, map_id, submap_id))";

// Older programs do not know this table, and read a database with it.
constexpr std::string_view kTrafficSchema =
    "CREATE TABLE IF NOT EXISTS traffic ("
    " vehicle_id TEXT NOT NULL, map_id INTEGER NOT NULL, submap_id INTEGER NOT NULL,"
    " record BLOB NOT NULL, PRIMARY KEY (vehicle_id, map_id, submap_id))";

/// The map to which a submap was added last.
std::int64_t latest_map(sqlite3* database, std::string_view vehicle_id) {
  Statement query(database,
                  "SELECT map_id FROM submap WHERE vehicle_id = ? ORDER BY rowid DESC LIMIT 1");
  query << vehicle_id;
  return query.step() ? query.integer(0) : 0;
}

/// Rolls back unless committed.
class Transaction {
 public:
  explicit Transaction(sqlite3* database) : database_(database) {
    Statement(database, "BEGIN IMMEDIATE").step();
  }
  ~Transaction() {
    if (open_) sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    Statement(database_, "COMMIT").step();
    open_ = false;
  }

 private:
  sqlite3* database_;
  bool open_ = true;
};

}  // namespace

void Store::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

std::variant<Store, std::string> Store::open(const std::filesystem::path& file,
                                             const MapStoreConfig& config) {
  std::error_code ignored_fault;
  if (file.has_parent_path())
    std::filesystem::create_directories(file.parent_path(), ignored_fault);
  sqlite3* handle = nullptr;
  const int result =
      sqlite3_open_v2(file.c_str(), &handle, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  Store store(std::unique_ptr<sqlite3, Close>(handle), file, config);
  if (result != SQLITE_OK) return file.string() + ": " + sqlite3_errstr(result);
  if (const auto fault = store.prepare()) return file.string() + ": " + *fault;
  store.identity_ = identity_of(file);
  return store;
}

std::optional<std::string> Store::prepare() {
  sqlite3* database = database_.get();
  try {
    sqlite3_busy_timeout(database, static_cast<int>(std::lround(config_.busy_timeout_s * 1e3)));
    Statement(database, "PRAGMA journal_mode = WAL").step();
    // FULL: a commit survives a power failure. At one submap every few seconds the cost is
    // negligible.
    Statement(database, "PRAGMA synchronous = FULL").step();
    if (config_.max_database_mb > 0) {
      const std::int64_t pages = std::int64_t{config_.max_database_mb} * 1024 * 1024 / kPageBytes;
      Statement(database, "PRAGMA max_page_count = " + std::to_string(pages)).step();
    }
    Statement version(database, "PRAGMA user_version");
    version.step();
    if (version.integer(0) > kSchemaVersion) return "written by a later version of slammot";
    if (version.integer(0) == 1)
      Statement(database, "ALTER TABLE submap RENAME COLUMN drive TO map_id").step();
    Statement(database, kSchema).step();
    Statement(database, kTrafficSchema).step();
    Statement(database, "PRAGMA user_version = " + std::to_string(kSchemaVersion)).step();
  } catch (const SqliteError& error) { return error.what(); }
  return std::nullopt;
}

PutResult Store::put_in_transaction(std::string_view vehicle_id, const flow::Submap& submap) {
  const std::string blob = to_blob(submap);
  Transaction transaction(database_.get());
  const auto map_id = static_cast<std::int64_t>(submap.map_id.value);
  {
    Statement known(database_.get(),
                    "SELECT last_stamp_ns, record FROM submap WHERE vehicle_id = ? AND map_id = ? "
                    "AND submap_id = ?");
    known << vehicle_id << map_id << std::int64_t{submap.submap_id.value};
    if (known.step()) {
      if (known.bytes(1) == blob) return PutResult::kKnown;
      if (known.integer(0) > submap.last_stamp_ns) return PutResult::kOlder;
    }
  }
  Statement insert(database_.get(), "INSERT OR REPLACE INTO submap VALUES (?, ?, ?, ?, ?, ?)");
  insert << vehicle_id << map_id << std::int64_t{submap.submap_id.value} << submap.first_stamp_ns
         << submap.last_stamp_ns;
  insert.bind_blob(blob).step();
  transaction.commit();
  return PutResult::kStored;
}

PutResult Store::put(std::string_view vehicle_id, const flow::Submap& submap) {
  last_fault_.clear();
  try {
    return put_in_transaction(vehicle_id, submap);
  } catch (const SqliteError& error) {
    last_fault_ = error.what();
    return PutResult::kFailed;
  }
}

std::optional<flow::Submap> Store::get(std::string_view vehicle_id, flow::SubmapId submap_id) {
  last_fault_.clear();
  try {
    Statement query(
        database_.get(),
        "SELECT record FROM submap WHERE vehicle_id = ? AND submap_id = ? AND map_id = ?");
    const std::int64_t map_id = latest_map(database_.get(), vehicle_id);
    query << vehicle_id << std::int64_t{submap_id.value} << map_id;
    if (!query.step()) return std::nullopt;
    std::optional<flow::Submap> submap = from_blob(query.bytes(0));
    if (submap) submap->map_id = {static_cast<std::uint64_t>(map_id)};
    if (!submap) last_fault_ = "submap " + std::to_string(submap_id.value) + " is damaged";
    return submap;
  } catch (const SqliteError& error) {
    last_fault_ = error.what();
    return std::nullopt;
  }
}

std::vector<flow::SubmapId> Store::list(std::string_view vehicle_id) {
  last_fault_.clear();
  std::vector<flow::SubmapId> submaps;
  try {
    Statement query(
        database_.get(),
        "SELECT submap_id FROM submap WHERE vehicle_id = ? AND map_id = ? ORDER BY submap_id");
    query << vehicle_id << latest_map(database_.get(), vehicle_id);
    while (query.step()) submaps.push_back({static_cast<std::uint32_t>(query.integer(0))});
  } catch (const SqliteError& error) { last_fault_ = error.what(); }
  return submaps;
}

std::vector<Store::StoredMap> Store::maps(std::string_view vehicle_id) {
  last_fault_.clear();
  std::vector<StoredMap> maps;
  try {
    Statement query(database_.get(),
                    "SELECT map_id, COUNT(*) FROM submap WHERE vehicle_id = ? GROUP BY map_id "
                    "ORDER BY MAX(rowid)");
    query << vehicle_id;
    while (query.step())
      maps.push_back({{static_cast<std::uint64_t>(query.integer(0))}, query.integer(1)});
  } catch (const SqliteError& error) { last_fault_ = error.what(); }
  return maps;
}

/// Replacing a row makes it the last one that was added.
bool Store::make_latest(std::string_view vehicle_id, flow::MapId map_id) {
  last_fault_.clear();
  try {
    Statement insert(database_.get(),
                     "INSERT OR REPLACE INTO submap SELECT * FROM submap WHERE vehicle_id = ? AND "
                     "map_id = ? ORDER BY submap_id DESC LIMIT 1");
    insert << vehicle_id << static_cast<std::int64_t>(map_id.value);
    insert.step();
    return sqlite3_changes(database_.get()) > 0;
  } catch (const SqliteError& error) {
    last_fault_ = error.what();
    return false;
  }
}

std::vector<std::string> Store::vehicles() {
  last_fault_.clear();
  std::vector<std::string> vehicles;
  try {
    Statement query(database_.get(), "SELECT DISTINCT vehicle_id FROM submap ORDER BY vehicle_id");
    while (query.step()) vehicles.emplace_back(query.bytes(0));
  } catch (const SqliteError& error) { last_fault_ = error.what(); }
  return vehicles;
}

}  // namespace slammot::map_store
