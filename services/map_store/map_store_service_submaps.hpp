#pragma once

#include <cstdint>
#include <map>
#include <set>

#include "common/app/service_context.hpp"
#include "common/dds/reader_watch.hpp"
#include "common/wire/submap.hpp"
#include "services/map_store/store.hpp"

namespace slammot::map_store {

/// Publishes stored submaps: each when it is stored, and all of them from the database when a
/// reader joins. The bus keeps tiles only until every reader has them, so that memory does not grow
/// with the map.
class StoredSubmaps {
 public:
  StoredSubmaps(app::ServiceContext& context, Store& store);

  void publish(const flow::Submap& submap);

  /// Ends what readers of the previous map still wait for.
  void withdraw();

  /// Call it often: sends for a few milliseconds what joining or slow readers lack, and frees what
  /// every reader has.
  void advance();

 private:
  bool write(const flow::Submap& submap);
  void end_kept();
  void free_received();

  app::ServiceContext& context_;
  Store& store_;
  dds::Writer<slammot_SubmapTile>& tiles_;
  dds::ReaderWatch readers_;
  wire::SubmapEncoder encoder_;
  std::map<flow::SubmapId, std::uint32_t> kept_;  ///< Number of tiles in the history of the bus.
  std::set<flow::SubmapId> due_;                  ///< Some reader may lack them.
};

}  // namespace slammot::map_store
