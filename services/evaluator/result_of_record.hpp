#pragma once

#include "common/files/run_record.hpp"
#include "services/evaluator/result_files.hpp"

namespace slammot::evaluator {

/// What read_result() reads of the folder that a run has just written, without reading the tables
/// again: trajectories and tracks from the record; graph, map and figures from the folder. Without
/// labels and predictions. The record must hold a localized scan.
files::Result<RunResult> result_of(const files::RunRecord& record,
                                   const std::filesystem::path& folder);

}  // namespace slammot::evaluator
