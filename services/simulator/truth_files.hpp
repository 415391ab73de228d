#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

/// PREFIX.tum, PREFIX.objects.csv and PREFIX.walls.csv, written while the drive goes on. Files of these names are replaced.
class TruthFiles {
 public:
  TruthFiles(const std::filesystem::path& prefix, const simulation::Outline& stationary_in_world);

  void add(const simulation::SimulatedScan& drive);

  /// Ends the files; why they are not complete, if they are not.
  std::optional<std::string> close();

  const std::filesystem::path& tum() const { return tum_path_; }
  const std::filesystem::path& objects() const { return objects_path_; }
  const std::filesystem::path& walls() const { return walls_path_; }
  double distance_m() const { return distance_m_; }

 private:
  std::filesystem::path tum_path_;
  std::filesystem::path objects_path_;
  std::filesystem::path walls_path_;
  std::ofstream tum_;
  std::ofstream objects_;
  std::ofstream walls_;
  std::optional<geometry::Pose2> last_;
  double distance_m_ = 0.0;
};

}  // namespace slammot::simulator
