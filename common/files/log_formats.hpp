#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "common/files/record_source.hpp"
#include "common/files/result.hpp"

namespace slammot::files {

struct RecordOptions {
  TopicOptions topics;
  std::size_t most_kept_bytes = std::size_t{48} << 20;  ///< Of a bag's scans kept by the survey;
                                                        ///< larger bags are read twice.
};

/// Opens a log by its content, not its name: text of CARMEN or DP-SLAM, plain or .gz; leg_tracker
/// text, as a file or folder (LegTrackerLog); a ROS bag, as a file (.bag 2.0, .mcap, .db3, also
/// zstd-compressed) or a folder of them (BagLog).
Result<std::unique_ptr<RecordSource>> open_records(const std::filesystem::path& path,
                                                   const RecordOptions& options = {});

}  // namespace slammot::files
