#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

/// Whether the files say which beam hit what.
enum class HitsFile { left_out, written };

/// PREFIX.tum, PREFIX.objects.csv, PREFIX.walls.csv and, if wanted, PREFIX.hits.csv, written while the drive goes on. Files of
/// these names are replaced. Poses and objects are those of the first scanner's scans, hits are of all.
class TruthFiles {
 public:
  TruthFiles(const std::filesystem::path& prefix, const simulation::Outline& stationary_in_world, HitsFile hits);

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
  std::optional<std::ofstream> hits_;
  std::optional<geometry::Pose2> last_;
  double distance_m_ = 0.0;
};

}  // namespace slammot::simulator
