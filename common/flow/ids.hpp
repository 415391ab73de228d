#pragma once

#include <compare>
#include <cstdint>

namespace slammot::flow {

/// Counts the submaps of one vehicle from 0, in the order in which they were begun.
struct SubmapId {
  std::uint32_t value = 0;
  auto operator<=>(const SubmapId&) const = default;
};

/// Names one tracked object of one vehicle for as long as it is believed; never used again.
struct TrackId {
  std::uint32_t value = 0;
  auto operator<=>(const TrackId&) const = default;
};

}  // namespace slammot::flow
