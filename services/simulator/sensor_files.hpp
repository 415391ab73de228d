#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

/// Files of sensor data: PREFIX.log of all scanners, PREFIX.SCANNER.log of each further scanner,
/// and PREFIX.gnss.csv and PREFIX.compass.csv if the vehicle has these sensors. Replaces existing
/// files.
class SensorFiles {
 public:
  SensorFiles(const std::filesystem::path& prefix, const simulation::ScenarioConfig& scenario);

  void add(const simulation::SimulatedScan& drive);

  /// Closes the files. Returns the reason if they are incomplete.
  std::optional<std::string> close();

  /// Logs in the order of the scanners, then files of the other sensors.
  const std::vector<std::filesystem::path>& paths() const { return paths_; }

 private:
  simulation::ScenarioConfig scenario_;
  std::vector<std::filesystem::path> paths_;
  std::vector<std::ofstream> files_;
  std::optional<std::size_t> gnss_;  ///< Index of the file.
  std::optional<std::size_t> compass_;
};

}  // namespace slammot::simulator
