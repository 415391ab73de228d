#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/simulation/scenario.hpp"
#include "services/simulator/truth_files.hpp"

namespace slammot::simulator {

/// Paths of a drive's files and summary figures.
struct DriveFiles {
  std::filesystem::path log;  ///< CARMEN: PARAM and ROBOTLASER1 or FLASER lines with odometry
                              ///< poses.
  std::vector<std::filesystem::path> more_sensors;  ///< A log of each further scanner, .gnss.csv,
                                                    ///< .compass.csv.
  std::filesystem::path tum;      ///< True pose of the vehicle's centre at each scan, in world.
  std::filesystem::path objects;  ///< CSV with one row for each moving object that a scan hit.
  std::filesystem::path walls;    ///< CSV of true segments: class 0 walls, 1 parked cars, 2 trees,
                                  ///< bushes and poles (octagons).
  std::size_t scans = 0;
  double distance_m = 0.0;
};

struct DriveFilesOrFault {
  std::optional<DriveFiles> files;
  std::string fault;  ///< Reason, if there are no files.
};

/// Without extensions.
struct DriveFileNames {
  std::string log;
  std::string truth;
};

/// Simulates the scenario and writes LOG.log, TRUTH.tum, TRUTH.objects.csv, TRUTH.walls.csv and the
/// files of SensorFiles and TruthFiles into a folder, which is created if it does not exist.
/// Replaces existing files.
DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario,
                              const std::filesystem::path& folder, const DriveFileNames& names,
                              HitsFile hits);

/// As above, with the scenario's name as the base name of all files.
DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario,
                              const std::filesystem::path& folder,
                              HitsFile hits = HitsFile::left_out);

}  // namespace slammot::simulator
