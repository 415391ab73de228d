#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "common/files/record_source.hpp"
#include "common/files/result.hpp"

namespace slammot::files {

struct RecordOptions {
  TopicOptions topics;
  std::size_t most_kept_bytes = std::size_t{48} << 20;   ///< Of a bag's scans, while it is looked through; more are read again.
};

/// Opens a log by what it holds, not by its name: CARMEN's or DP-SLAM's text, plain or .gz; leg_tracker's text, as a file or as a
/// folder (LegTrackerLog); a ROS bag, as a file (.bag 2.0, .mcap, .db3, these packed by zstd) or as a folder of them (BagLog).
Result<std::unique_ptr<RecordSource>> open_records(const std::filesystem::path& path, const RecordOptions& options = {});

}  // namespace slammot::files
