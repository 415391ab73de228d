#pragma once

#include <compare>
#include <cstdint>

namespace slammot::flow {

/// Counts the submaps of one map from 0, in the order in which they were begun.
struct SubmapId {
  std::uint32_t value = 0;
  auto operator<=>(const SubmapId&) const = default;
};

/// Names one map of a vehicle: another one where localization began anew and did not go on in that of drives before. 0 where
/// there is only one, as in one process.
struct MapId {
  std::uint64_t value = 0;
  auto operator<=>(const MapId&) const = default;
};

/// Names the frame odom of one drive of a vehicle: another one where localization began anew, be it in the same map, so that
/// nothing that was in odom before means anything in it. 0 where there is only one, as in one process.
struct OdomId {
  std::uint64_t value = 0;
  auto operator<=>(const OdomId&) const = default;
};

/// Names one tracked object of one vehicle for as long as it is believed; never used again.
struct TrackId {
  std::uint32_t value = 0;
  auto operator<=>(const TrackId&) const = default;
};

}  // namespace slammot::flow
