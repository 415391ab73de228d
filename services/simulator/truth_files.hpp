#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

/// Whether the files say which beam hit what.
enum class HitsFile { left_out, written };

/// PREFIX.tum, PREFIX.objects.csv, PREFIX.walls.csv and, if wanted, PREFIX.hits.csv, written while
/// the drive goes on. Files of these names are replaced. Poses and objects are those of each stamp
/// of a scan, hits those of each scan; an object is in view if the scan or the newest one of
/// another scanner hit it, and its points are the beams of all of these.
class TruthFiles {
 public:
  TruthFiles(const std::filesystem::path& prefix, const simulation::Outline& stationary_in_world,
             HitsFile hits);

  void add(const simulation::SimulatedScan& drive);

  /// Ends the files; why they are not complete, if they are not.
  std::optional<std::string> close();

  const std::filesystem::path& tum() const { return tum_path_; }
  const std::filesystem::path& objects() const { return objects_path_; }
  const std::filesystem::path& walls() const { return walls_path_; }
  double distance_m() const { return distance_m_; }

 private:
  simulation::SimulatedScan seen_by_any(const simulation::SimulatedScan& drive);
  void write_newest();

  std::filesystem::path tum_path_;
  std::filesystem::path objects_path_;
  std::filesystem::path walls_path_;
  std::ofstream tum_;
  std::ofstream objects_;
  std::ofstream walls_;
  std::optional<std::ofstream> hits_;
  std::map<std::size_t, std::map<int, int>> points_by_scanner_;  // and object, of the newest scan
  std::optional<simulation::SimulatedScan> newest_;  // not written yet: another scanner may share
                                                     // its stamp
  std::optional<geometry::Pose2> last_;
  double distance_m_ = 0.0;
};

}  // namespace slammot::simulator
