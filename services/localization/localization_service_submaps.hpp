#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "common/app/service_context.hpp"
#include "common/flow/stored_map.hpp"
#include "common/wire/submap.hpp"

namespace slammot::localization {

/// Publishes submaps, tile by tile.
class SubmapPublisher {
 public:
  explicit SubmapPublisher(app::ServiceContext& context);

  void publish(const flow::Submap& submap);

  /// Ends the instances of all tiles, so that a map_store that starts later does not take them for
  /// those of the next map.
  void withdraw();

  /// Ends the instances of tiles that map_store has: memory does not grow with the way. Not where
  /// it lacks a submap before them.
  void release(const flow::StoredMap& stored);

  /// The newest submap since the last withdrawal.
  std::optional<flow::SubmapId> newest() const;

 private:
  void end_tiles(flow::SubmapId submap_id, std::uint32_t tiles);

  app::ServiceContext& context_;
  dds::Writer<slammot_SubmapTile>& tiles_;
  wire::SubmapEncoder encoder_;
  std::map<flow::SubmapId, std::uint32_t> tiles_of_;  ///< Number of tiles of each submap.
  std::optional<flow::SubmapId> newest_;
};

}  // namespace slammot::localization
