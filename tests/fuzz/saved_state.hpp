#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "common/memory/byte_stream.hpp"

namespace slammot::testing {

/// With the checksum that fits, as a state would have that was written by a fault rather than
/// damaged on disk.
inline std::vector<std::byte> sealed_again(std::vector<std::byte> bytes) {
  bytes.resize(bytes.size() - sizeof(std::uint64_t));
  memory::put(bytes, memory::checksum(bytes));
  return bytes;
}

/// A number that stands out, of eight bytes, at any place: most of the state are such numbers.
inline void put_strange_number(std::vector<std::byte>& bytes, std::size_t place,
                               std::mt19937& random) {
  const double strange[] = {std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity(),
                            -1e300,
                            1e300,
                            0.0,
                            1e-320,
                            -1.0};
  std::uint64_t number = (std::uint64_t{random()} << 32) | random();
  if (random() % 2 == 0) std::memcpy(&number, &strange[random() % 7], sizeof number);
  std::memcpy(bytes.data() + place, &number, std::min(sizeof number, bytes.size() - place));
}

}  // namespace slammot::testing
