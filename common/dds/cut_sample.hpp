#pragma once

#include <cstdint>

struct ddsi_serdata;

namespace slammot::dds {

/// Reads a serialized sample into `into`, of its type and zeroed. False where it is delimited (OMG
/// DDS-XTypes 1.3, 7.4.3.5.3: D_CDR2) with less than `least_bytes`, or cannot be read.
bool read_whole(const ddsi_serdata* serialized, std::uint32_t least_bytes, void* into);

}  // namespace slammot::dds
