#pragma once

#include <functional>
#include <optional>

#include "common/mcap/file.hpp"

namespace slammot::mcap {

/// Calls handle(opcode, content) for each whole record.
void for_each_record(Bytes records,
                     const std::function<void(std::uint8_t opcode, Bytes content)>& handle);

/// The contents as the summary at the file's end states them; none without one, or if its checksum
/// fails.
std::optional<Contents> read_summary(const FileBytes& bytes);

/// The contents of all records from the file's beginning to where they end or stop making sense.
/// Chunks that do not unpack or fail their checksum are left out, and named as damage.
Contents scan(const FileBytes& bytes);

}  // namespace slammot::mcap
