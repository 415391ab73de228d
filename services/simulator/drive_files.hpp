#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/simulation/scenario.hpp"
#include "services/simulator/truth_files.hpp"

namespace slammot::simulator {

/// Where a drive's files were written, and how much it was.
struct DriveFiles {
  std::filesystem::path log;  ///< CARMEN: PARAM and ROBOTLASER1 or FLASER lines, poses by odometry.
  std::vector<std::filesystem::path> more_sensors;  ///< A log of each further scanner, .gnss.csv,
                                                    ///< .compass.csv.
  std::filesystem::path tum;      ///< True pose of the vehicle's centre for each scan, world frame.
  std::filesystem::path objects;  ///< CSV, one row for each moving object that a scan hit.
  std::filesystem::path walls;    ///< CSV, true segments: class 0 walls, 1 parked cars, 2 trees,
                                  ///< bushes and poles (as octagons).
  std::size_t scans = 0;
  double distance_m = 0.0;
};

struct DriveFilesOrFault {
  std::optional<DriveFiles> files;
  std::string fault;  ///< Why there are no files.
};

/// Without their endings.
struct DriveFileNames {
  std::string log;
  std::string truth;
};

/// Drives the scenario and writes LOG.log, TRUTH.tum, TRUTH.objects.csv, TRUTH.walls.csv and what
/// else there is (SensorFiles, TruthFiles) into a folder, which is made where it is missing. Files
/// of the same name are replaced.
DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario,
                              const std::filesystem::path& folder, const DriveFileNames& names,
                              HitsFile hits);

/// The same with the scenario's name for all.
DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario,
                              const std::filesystem::path& folder,
                              HitsFile hits = HitsFile::left_out);

}  // namespace slammot::simulator
