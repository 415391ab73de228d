#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/wire/graph.hpp"
#include "common/wire/submap.hpp"
#include "common/wire/traffic_ways.hpp"
#include "services/gateway/audience.hpp"
#include "services/gateway/map_messages.hpp"
#include "services/gateway/map_view.hpp"

namespace slammot::gateway {

/// Publishes the map in use: submaps under paths of their own, the graph and the way as messages,
/// and the whole map as grids while somebody subscribes to them. Submaps are compressed and grids
/// drawn beside the caller, whom a whole map, as after a seek, would keep for a second.
class MapPublisher {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit MapPublisher(Audience& audience) : audience_(audience) {}
  ~MapPublisher() = default;  ///< Waits for what is in work.

  /// Each returns the reason of a rejection; empty if accepted.
  std::string_view take(const slammot_SubmapTile& tile);
  std::string_view take(const slammot_GraphCorrection& part);
  std::string_view take(const slammot_TrafficWays& part);
  void take(const flow::Constraint& constraint);
  void follow(const flow::LocalizedScan& scan);

  /// Publishes what changed. Call it a few times a second.
  void publish(Time now);
  /// Waits until what has been taken is made: the next publish() has it.
  void finish();

 private:
  /// As it is served.
  struct ShownView {
    std::shared_ptr<const flow::Submap> view;
    std::uint64_t version = 0;
    std::string compressed_cells{};
  };

  MapView& view_of(flow::MapId map_id);
  void begin_submaps();
  void publish_submaps();
  void add(ShownView submap);
  void publish_graph();
  void publish_way(Time now);
  void publish_ways();
  void publish_grids(Time now);

  Audience& audience_;
  wire::SubmapAssembler submaps_;
  wire::GraphCorrectionAssembler corrections_;
  wire::TrafficWaysAssembler traffic_;
  std::optional<traffic::TrafficWays> ways_;  ///< That are not published.
  std::vector<ShownView> arrived_;            ///< Not compressed.
  std::future<std::vector<ShownView>> in_work_;
  std::map<flow::MapId, MapView> views_;
  std::map<std::string, std::string> served_;  ///< Path by map and submap.
  std::optional<flow::MapId> in_use_;
  std::int64_t stamp_ns_ = 0;
  bool has_new_graph_ = false;
  bool has_new_map_ = false;
  Time way_due_{};
  Time grids_due_{};
  std::future<MapGrids> grids_;
};

}  // namespace slammot::gateway
