#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/app/service_context.hpp"
#include "common/traffic/map_traffic.hpp"
#include "common/traffic/traffic_collector.hpp"
#include "common/traffic/ways_pace.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/traffic_ways.hpp"
#include "services/map_store/store.hpp"

namespace slammot::map_store {

/// Keeps what moved beside the submaps during which it moved, and publishes the lanes and walkways
/// of the map. Ways are found in a thread of their own, as often as the data's stamps allow
/// (ways_pace.hpp), and once more when no data comes.
class TrafficOfSubmaps {
 public:
  TrafficOfSubmaps(app::ServiceContext& context, Store& store);

  /// Reads the stored traffic of another map, and publishes its ways from now on.
  void begin_map(flow::MapId map_id);

  void take(const slammot_TrackedObjects& objects);
  void take(const slammot_GraphCorrection& part);

  /// Of a submap that was stored just now.
  void finish(const flow::Submap& submap);

  /// Tries again what could not be written.
  void retry();

  /// Publishes ways that were found, and has them found anew if something changed. Call it often.
  void advance();

 private:
  struct Found {
    std::vector<traffic::Way> ways;
    flow::MapId map_id;
    std::chrono::nanoseconds took{};
  };
  struct Drive {
    flow::MapId map_id;
    flow::OdomId odom_id;
    geometry::Pose2 map_from_odom;
    std::int64_t stamp_ns = 0;                     ///< Of the newest tracks.
    std::optional<flow::SubmapId> first_submap{};  ///< That ended during it.
    bool is_located = false;                       ///< In the stored map, if it continues one.
  };
  using SubmapOfMap = std::pair<flow::MapId, flow::SubmapId>;

  void begin_drive(const flow::TrackedObjects& objects);
  bool may_find() const;
  bool has_changed();
  std::vector<traffic::PlacedTraffic> all_placed() const;
  void find();
  void publish(Found found);
  void report();

  app::ServiceContext& context_;
  Store& store_;
  dds::Writer<slammot_TrafficWays>& writer_;
  wire::GraphCorrectionAssembler corrections_;
  traffic::TrafficCollector collector_;
  traffic::MapTraffic traffic_;
  std::optional<flow::MapId> map_id_;  ///< Of the traffic; none before the first drive.
  std::optional<Drive> drive_;
  std::uint32_t told_parts_ = 0;  ///< Of the collector, in the last ways.
  std::uint32_t sequence_ = 0;
  std::map<SubmapOfMap, std::vector<traffic::FreeStream>> unwritten_;
  traffic::WaysPace pace_;
  std::chrono::steady_clock::time_point last_data_{};
  std::future<Found> finding_;
};

}  // namespace slammot::map_store
