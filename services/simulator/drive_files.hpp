#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/simulation/scenario.hpp"

namespace slammot::simulator {

/// Where a drive's files were written, and how much it was.
struct DriveFiles {
  std::filesystem::path log;       ///< CARMEN: PARAM and ROBOTLASER1 or FLASER lines, poses by odometry.
  std::filesystem::path tum;       ///< True pose of the vehicle's centre for each scan, world frame.
  std::filesystem::path objects;   ///< CSV, one row for each moving object that a scan hit.
  std::filesystem::path walls;     ///< CSV, true segments: class 0 walls, 1 parked cars, 2 trees, bushes and poles (as octagons).
  std::size_t scans = 0;
  double distance_m = 0.0;
};

struct DriveFilesOrFault {
  std::optional<DriveFiles> files;
  std::string fault;               ///< Why there are no files.
};

/// Without their endings.
struct DriveFileNames {
  std::string log;
  std::string truth;
};

/// Drives the scenario and writes LOG.log, TRUTH.tum, TRUTH.objects.csv and TRUTH.walls.csv into a folder, which is made
/// where it is missing. Files of the same name are replaced.
DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario, const std::filesystem::path& folder, const DriveFileNames& names);

/// The same with the scenario's name for all.
DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario, const std::filesystem::path& folder);

}  // namespace slammot::simulator
