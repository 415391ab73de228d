#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/flow/ids.hpp"

namespace slammot::ingest {

/// Whether the drive is ahead of loop closing: a submap is finished and its place in the graph not
/// yet published. Played at the recorded speed that never lasts; played as fast as possible the
/// drive waits, so that corrections come as early in it as they would on a vehicle. Time is a
/// parameter.
class GraphWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// patience: how long a drive waits for one submap, and for a sign of life.
  explicit GraphWatch(std::chrono::nanoseconds patience) : patience_(patience) {}

  /// A heartbeat of loop_closing.
  void heard(Time now) { last_heard_ = now; }

  /// The submap that localization is working on: those before it are finished.
  void is_in_use(flow::MapId map_id, std::uint32_t submap_id, Time now) {
    if (map_id == map_id_ && submap_id <= in_use_) return;
    map_id_ = map_id;
    in_use_ = submap_id;
    waiting_since_ = now;
  }

  /// A correction that contains submaps up to this one.
  void is_placed(flow::MapId map_id, std::uint32_t submap_id) {
    placed_ = Placed{map_id, submap_id};
  }

  bool is_behind(Time now) const {
    const bool is_missing =
        in_use_ > 0 && (!placed_ || placed_->map_id != map_id_ || placed_->submap_id + 1 < in_use_);
    // While it looks for a place everywhere in a map it is silent for seconds.
    const bool is_at_work = last_heard_ && now - *last_heard_ < patience_;
    return is_missing && is_at_work && now - waiting_since_ < patience_;
  }

 private:
  struct Placed {
    flow::MapId map_id;
    std::uint32_t submap_id;
  };

  std::chrono::nanoseconds patience_;
  flow::MapId map_id_;
  std::uint32_t in_use_ = 0;
  std::optional<Placed> placed_;
  std::optional<Time> last_heard_;
  Time waiting_since_{};
};

}  // namespace slammot::ingest
