#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/mcap/file.hpp"
#include "services/gateway/viewer_file.hpp"

namespace slammot::gateway {

struct ConvertedRecording {
  std::uint64_t messages = 0;
  std::uint64_t dropped = 0;  ///< Samples that were malformed.
  std::string vehicle_id;     ///< Whose samples were converted; empty: there were none.
  std::string fault;          ///< Empty on success.
};

/// Writes the messages that viewers of the recorded drive were sent into an MCAP file of this
/// format. `vehicle_id`: of a recording of several vehicles; empty: the first in it.
ConvertedRecording convert_recording(const mcap::File& recording,
                                     const std::filesystem::path& output, MessageFormat& format,
                                     const std::string& vehicle_id);

}  // namespace slammot::gateway
