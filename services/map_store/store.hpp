#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/flow/submap.hpp"
#include "services/map_store/map_store_config.hpp"

struct sqlite3;

namespace slammot::map_store {

enum class PutResult {
  kStored,  ///< Committed: survives a crash of this process and of the machine.
  kKnown,   ///< The same submap was already there.
  kOlder,   ///< A later version of it is there.
  kFailed,  ///< Not stored; last_fault() says why.
};

/// Finished submaps of all vehicles in one SQLite file.
///
/// get() and list() speak of the vehicle's latest map, the one to which a submap was added last;
/// earlier ones stay in the file. One thread at a time. Several processes may have the same file
/// open.
class Store {
 public:
  /// Opens the database or makes it, folders too. Otherwise why that is not possible, in one line.
  static std::variant<Store, std::string> open(const std::filesystem::path& file,
                                               const MapStoreConfig& config);

  /// Repeating it changes nothing. Of two versions of a submap of one map the one with the later
  /// last stamp stays.
  PutResult put(std::string_view vehicle_id, const flow::Submap& submap);

  /// Nothing when there is none or it is damaged (then last_fault() is not empty).
  std::optional<flow::Submap> get(std::string_view vehicle_id, flow::SubmapId submap_id);

  /// Ascending.
  std::vector<flow::SubmapId> list(std::string_view vehicle_id);

  struct StoredMap {
    flow::MapId map_id;
    std::int64_t submaps = 0;
  };
  /// Of the vehicle, the latest one last.
  std::vector<StoredMap> maps(std::string_view vehicle_id);

  /// From now on it is the vehicle's latest map. False where there is no such map, or it could not
  /// be done (then last_fault() is not empty).
  bool make_latest(std::string_view vehicle_id, flow::MapId map_id);

  /// All that have a submap, sorted.
  std::vector<std::string> vehicles();

  /// Why the last call failed; empty when it did not.
  const std::string& last_fault() const { return last_fault_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  explicit Store(std::unique_ptr<sqlite3, Close> database) : database_(std::move(database)) {}

  std::optional<std::string> prepare(const MapStoreConfig& config);
  PutResult put_in_transaction(std::string_view vehicle_id, const flow::Submap& submap);

  std::unique_ptr<sqlite3, Close> database_;
  std::string last_fault_;
};

}  // namespace slammot::map_store
