#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/flow/submap.hpp"
#include "common/traffic/traffic_map.hpp"
#include "services/map_store/map_store_config.hpp"

struct sqlite3;

namespace slammot::map_store {

enum class PutResult {
  kStored,  ///< Committed: survives a crash of the process or the machine.
  kKnown,   ///< An equal submap is stored already.
  kOlder,   ///< A later version is stored already.
  kFailed,  ///< Not stored; last_fault() gives the reason.
};

/// Finished submaps of all vehicles in one SQLite file.
///
/// get() and list() refer to the vehicle's latest map, to which a submap was added last; earlier
/// maps stay in the file. Not thread-safe. Several processes may open one file.
class Store {
 public:
  /// Opens or creates the database and its folders. Returns one line if that fails.
  static std::variant<Store, std::string> open(const std::filesystem::path& file,
                                               const MapStoreConfig& config);

  /// Stores a submap; idempotent. Of two versions of a submap of one map the one with the later
  /// last stamp is kept.
  PutResult put(std::string_view vehicle_id, const flow::Submap& submap);

  /// nullopt if there is no such submap, or if it is damaged (last_fault() is then not empty).
  std::optional<flow::Submap> get(std::string_view vehicle_id, flow::SubmapId submap_id);

  /// Ids of the stored submaps, ascending.
  std::vector<flow::SubmapId> list(std::string_view vehicle_id);

  struct StoredMap {
    flow::MapId map_id;
    std::int64_t submaps = 0;
  };
  /// Maps of the vehicle, the latest one last.
  std::vector<StoredMap> maps(std::string_view vehicle_id);

  /// Makes a map the vehicle's latest one. False if there is no such map, or on a fault
  /// (last_fault() is then not empty).
  bool make_latest(std::string_view vehicle_id, flow::MapId map_id);

  /// Stores what moved while the submap was in use, in its frame; it is added to what the submap
  /// has already. False on a fault (last_fault() is then not empty).
  bool add_traffic(std::string_view vehicle_id, flow::MapId map_id, flow::SubmapId submap_id,
                   std::vector<traffic::FreeStream> streams);

  struct StoredTraffic {
    flow::SubmapId submap_id;
    std::optional<std::vector<traffic::FreeStream>> streams;  ///< nullopt: damaged.
  };
  /// Traffic of a map, by ascending submaps. On a fault last_fault() is not empty.
  std::vector<StoredTraffic> traffic(std::string_view vehicle_id, flow::MapId map_id);

  /// All vehicles with submaps, sorted.
  std::vector<std::string> vehicles();

  enum class FileState {
    kThere,
    kWrittenAnew,  ///< It had been deleted: everything stored is in a new one.
    kGone,  ///< last_fault() gives the reason; what is stored since is lost with the process.
  };
  /// Looks whether the database is still where it was opened. An open file that is deleted can be
  /// written and read until it is closed, and nobody notices.
  FileState keep_file();

  /// Reason of the last call's failure; empty after success.
  const std::string& last_fault() const { return last_fault_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  /// The file itself, whatever its name.
  struct Identity {
    dev_t device = 0;
    ino_t number = 0;
    bool operator==(const Identity&) const = default;
  };
  Store(std::unique_ptr<sqlite3, Close> database, std::filesystem::path file,
        const MapStoreConfig& config)
      : database_(std::move(database)), file_(std::move(file)), config_(config) {}

  static std::optional<Identity> identity_of(const std::filesystem::path& file);
  std::optional<std::string> write_anew();
  std::optional<std::string> prepare();
  PutResult put_in_transaction(std::string_view vehicle_id, const flow::Submap& submap);

  std::unique_ptr<sqlite3, Close> database_;
  std::filesystem::path file_;
  MapStoreConfig config_;
  std::optional<Identity> identity_;  ///< Of the open file.
  std::string last_fault_;
};

}  // namespace slammot::map_store
