#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/app/run_service.hpp"
#include "common/wire/stored_map.hpp"
#include "common/wire/submap.hpp"
#include "services/map_store/map_store_service_submaps.hpp"
#include "services/map_store/map_store_service_traffic.hpp"
#include "services/map_store/store.hpp"

namespace slammot::map_store {

/// Publishes the last tracks every 0.1 s of the data's clock: a tracking service that restarts
/// after a crash restores them. Until there are some, it is told that there are none.
class TrackRelay {
 public:
  explicit TrackRelay(app::ServiceContext& context);
  void take(const slammot_TrackedObjects& objects);

 private:
  dds::Writer<slammot_TrackedObjects>& writer_;
  std::optional<std::int64_t> relayed_ns_;  ///< Stamp of the last objects in it.
};

/// Assembles finished submaps from their tiles, commits them to the database, and publishes
/// committed submaps, and the lanes and walkways of what moved meanwhile.
class MapStoreService {
 public:
  struct Settings {
    MapStoreConfig config;
    std::filesystem::path database;       ///< Empty: map.sqlite in the state folder.
    std::optional<std::uint64_t> map_id;  ///< Map to use as the latest; default: the map to which a
                                          ///< submap was added last.
  };
  static constexpr const char* kName = "map_store";
  static constexpr const char* kPurpose =
      "Stores the finished submaps of a vehicle, so that no crash loses one.";
  static constexpr bool kGivesWay = true;
  static constexpr bool kKeepsState = true;
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App& command_line, Settings& settings);

  /// Throws app::Unavailable if the database cannot be used, app::StartupFailure if it has no such
  /// map.
  MapStoreService(app::ServiceContext& context, const Settings& settings);

 private:
  void read_inputs();
  void take(const slammot_SubmapTile& tile);
  bool store(const flow::Submap& submap);
  void defer(flow::Submap submap);
  void keep_file();
  void retry();
  void read_stored();
  void note(const flow::Submap& submap);
  void begin_map();
  void report_other_vehicles();
  void publish_stored_map();

  app::ServiceContext& context_;
  MapStoreConfig config_;
  Store store_;
  wire::SubmapAssembler assembler_;
  StoredSubmaps stored_submaps_;
  TrafficOfSubmaps traffic_;
  TrackRelay relay_;
  dds::Writer<slammot_StoredMap>& stored_map_;
  std::deque<flow::Submap> unwritten_;
  std::set<flow::SubmapId> readable_;
  std::set<flow::SubmapId> unreadable_;  ///< Damaged records.
  flow::MapId map_id_;                   ///< Map of the latest stored submap.
  double cell_size_m_ = 0.0;             ///< Cell size of the latest stored submap.
};

}  // namespace slammot::map_store
