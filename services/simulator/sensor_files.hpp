#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

/// What the sensors of a drive said: PREFIX.log of all scanners, PREFIX.SCANNER.log of each further
/// one alone, and PREFIX.gnss.csv and PREFIX.compass.csv where the vehicle has such. Files of these
/// names are replaced.
class SensorFiles {
 public:
  SensorFiles(const std::filesystem::path& prefix, const simulation::ScenarioConfig& scenario);

  void add(const simulation::SimulatedScan& drive);

  /// Ends the files; why they are not complete, if they are not.
  std::optional<std::string> close();

  /// In the order of the scanners, then those of the other sensors.
  const std::vector<std::filesystem::path>& paths() const { return paths_; }

 private:
  simulation::ScenarioConfig scenario_;
  std::vector<std::filesystem::path> paths_;
  std::vector<std::ofstream> files_;
  std::optional<std::size_t> gnss_;  ///< Index of its file.
  std::optional<std::size_t> compass_;
};

}  // namespace slammot::simulator
