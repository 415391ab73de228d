#pragma once

#include <compare>
#include <cstdint>

namespace slammot::flow {

/// Number of a submap within its map, from 0, in order of creation.
struct SubmapId {
  std::uint32_t value = 0;
  auto operator<=>(const SubmapId&) const = default;
};

/// Identity of a map of a vehicle. It changes if localization restarts without continuing the
/// previous map. 0 if there is only one, as in one process.
struct MapId {
  std::uint64_t value = 0;
  auto operator<=>(const MapId&) const = default;
};

/// Identity of the odom frame of a drive. It changes if localization restarts, even in the same
/// map: earlier coordinates in odom are invalid then. 0 if there is only one, as in one process.
struct OdomId {
  std::uint64_t value = 0;
  auto operator<=>(const OdomId&) const = default;
};

/// Identity of a tracked object of one vehicle over its lifetime; never reused.
struct TrackId {
  std::uint32_t value = 0;
  auto operator<=>(const TrackId&) const = default;
};

}  // namespace slammot::flow
