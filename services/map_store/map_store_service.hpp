#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/app/run_service.hpp"
#include "common/wire/stored_map.hpp"
#include "common/wire/submap.hpp"
#include "services/map_store/store.hpp"

namespace slammot::map_store {

/// Puts finished submaps together from their tiles, commits them, and publishes what is committed.
class MapStoreService {
 public:
  struct Settings {
    MapStoreConfig config;
    std::filesystem::path database;       ///< Empty: map.sqlite in the state folder.
    std::optional<std::uint64_t> map_id;  ///< To be the latest again; none: it is the one to which
                                          ///< a submap was added last.
  };
  static constexpr const char* kName = "map_store";
  static constexpr const char* kPurpose =
      "Stores the finished submaps of a vehicle, so that no crash loses one.";
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App& command_line, Settings& settings);

  /// Throws app::StartupFailure when the database cannot be used.
  MapStoreService(app::ServiceContext& context, const Settings& settings);

 private:
  void take(const slammot_SubmapTile& tile);
  bool keep(const flow::Submap& submap);
  void put_off(flow::Submap submap);
  void retry();
  void publish_stored();
  void publish(const flow::Submap& submap);
  void withdraw_what_is_no_more();
  void tell_of_other_vehicles();
  void publish_stored_map();

  app::ServiceContext& context_;
  MapStoreConfig config_;
  Store store_;
  wire::SubmapAssembler assembler_;
  wire::SubmapEncoder encoder_;
  dds::Writer<slammot_SubmapTile>& stored_tiles_;
  dds::Writer<slammot_TrackedObjects>& stored_objects_;
  dds::Writer<slammot_StoredMap>& stored_map_;
  std::deque<flow::Submap> unwritten_;
  std::set<flow::SubmapId> unpublished_;  ///< In the database, but not all tiles got onto the bus.
  std::map<flow::SubmapId, std::uint32_t> published_;  ///< Number of tiles.
  std::set<flow::SubmapId> unreadable_;                ///< Damaged, and not come again since.
  flow::MapId map_id_;                                 ///< Of what was published last,
  double cell_size_m_ = 0.0;                           ///< and of its cells.
};

}  // namespace slammot::map_store
