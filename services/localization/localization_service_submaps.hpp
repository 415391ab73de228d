#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "common/app/service_context.hpp"
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

  /// The newest submap since the last withdrawal.
  std::optional<flow::SubmapId> newest() const;

 private:
  app::ServiceContext& context_;
  dds::Writer<slammot_SubmapTile>& tiles_;
  wire::SubmapEncoder encoder_;
  std::map<flow::SubmapId, std::uint32_t> tiles_of_;  ///< Number of tiles of each submap.
};

}  // namespace slammot::localization
