#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/city_model/profile_model.hpp"
#include "common/files/carmen_log.hpp"
#include "common/files/result.hpp"
#include "services/evaluator/result_files.hpp"

namespace slammot {

/// Which log and which of its scanners.
struct ModelInput {
  std::filesystem::path log;
  std::vector<std::string> scanners;  ///< Names; empty: all that scan vertically.
  files::TopicOptions topics;
};

/// A scan that went into the model: what a PlacedEcho::scan counts.
struct ModelledScan {
  std::int64_t stamp_ns = 0;
  std::size_t beams = 0;
  std::string scanner;
};

struct ModelOfLog {
  city_model::CityModel model;
  std::vector<ModelledScan> scans;
  std::vector<files::ScannerPlan> scanners;
  files::LogFaults faults;  ///< Of the log.
};

/// Trajectories, boxes of tracks where they were seen, and SO-map of a result.
city_model::EstimatedDrive drive_of(const evaluator::RunResult& result);

/// Fails with one line if the log has no vertical scanner, or its scans are not those of the
/// result: most stamps must be the same.
files::Result<ModelOfLog> model_of(const evaluator::RunResult& result, const ModelInput& input);

}  // namespace slammot
