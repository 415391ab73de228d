#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace slammot::dds {

/// Type of a topic as its writers describe it on the bus (OMG DDS-XTypes 1.3, 7.6.3): enough to
/// read, write and print samples of a type that was not compiled in.
struct RawType {
  std::string name;                       ///< "slammot::LaserScan"
  std::vector<std::uint8_t> information;  ///< TypeInformation; XCDR2, little endian.
  std::vector<std::uint8_t> mapping;      ///< TypeMapping: the type and all that it consists of.

  bool operator==(const RawType&) const = default;
};

}  // namespace slammot::dds
