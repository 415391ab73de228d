#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "common/traffic/traffic_ways.hpp"
#include "common/wire/part_collector.hpp"
#include "idl/mapping.h"

namespace slammot::wire {

inline constexpr std::size_t kMostWaysOfPart = 1024;
inline constexpr std::size_t kMostWayPointsOfPart = 8192;
inline constexpr std::size_t kMostPartsOfWays = 64;

/// Splits ways into parts that fit on the bus; reuses its buffers.
class TrafficWaysEncoder {
 public:
  /// Calls `write` with each part, valid only during the call. Ways beyond the greatest number of
  /// parts are left out: returns how many. So are points of a way beyond a part's.
  std::size_t encode(std::string_view vehicle_id, const traffic::TrafficWays& ways,
                     const std::function<void(const slammot_TrafficWays&)>& write);

 private:
  void fill(const std::vector<traffic::Way>& ways, std::size_t begin, std::size_t end);

  slammot_TrafficWays sample_{};
  std::vector<slammot_TrafficWay> ways_;
  std::vector<slammot_Point2f> points_;
};

/// Reassembles ways from parts in any order. Use one a vehicle.
class TrafficWaysAssembler {
 public:
  /// The ways if this was their last missing part; nothing (and no fault) if parts are missing.
  struct Added {
    std::optional<traffic::TrafficWays> ways;
    std::string_view fault;  ///< Reason of rejection; empty if accepted.
  };
  Added add(const slammot_TrafficWays& part);

 private:
  struct Shared {
    std::int64_t stamp_ns = 0;
    flow::MapId map_id;

    bool operator==(const Shared&) const = default;
  };

  PartCollector<Shared, traffic::Way> parts_;
};

}  // namespace slammot::wire
