#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/flow/ids.hpp"

namespace slammot::ingest {

/// Detects that loop closing is behind: a finished submap is not in the published graph yet. At
/// speed max ingest then waits, so that corrections arrive as early in the drive as at the recorded
/// speed. Time is a parameter.
class GraphWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `patience`: longest wait for a submap, and longest silence of loop_closing.
  explicit GraphWatch(std::chrono::nanoseconds patience) : patience_(patience) {}

  /// Call at each heartbeat of loop_closing.
  void heard(Time now) { last_heard_ = now; }

  /// The current submap of localization; earlier ones are finished.
  void set_current(flow::MapId map_id, std::uint32_t submap_id, Time now) {
    if (map_id == map_id_ && submap_id <= current_) return;
    map_id_ = map_id;
    current_ = submap_id;
    waiting_since_ = now;
  }

  /// Call at each correction, with the latest submap in it.
  void set_placed(flow::MapId map_id, std::uint32_t submap_id) {
    placed_ = Placed{map_id, submap_id};
  }

  bool is_behind(Time now) const {
    const bool is_missing = current_ > 0 && (!placed_ || placed_->map_id != map_id_ ||
                                             placed_->submap_id + 1 < current_);
    // During a search everywhere in a map, loop_closing is silent for seconds.
    const bool is_operational = last_heard_ && now - *last_heard_ < patience_;
    return is_missing && is_operational && now - waiting_since_ < patience_;
  }

 private:
  struct Placed {
    flow::MapId map_id;
    std::uint32_t submap_id;
  };

  std::chrono::nanoseconds patience_;
  flow::MapId map_id_;
  std::uint32_t current_ = 0;
  std::optional<Placed> placed_;
  std::optional<Time> last_heard_;
  Time waiting_since_{};
};

}  // namespace slammot::ingest
