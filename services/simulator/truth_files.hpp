#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "common/simulation/drive.hpp"

namespace slammot::simulator {

/// Selects whether the hits of beams are written.
enum class HitsFile { left_out, written };

/// Writes PREFIX.tum, PREFIX.objects.csv, PREFIX.walls.csv and optionally PREFIX.hits.csv during
/// the drive. Replaces existing files. Poses and objects are written once per stamp, hits once per
/// scan. An object is in view if the scan or the latest scan of another scanner hit it; its points
/// are the beams of all these scans. For 10 s after it was in view an object is hidden: it has a
/// row without points, so that a track through an occlusion can be judged. Of a scanner of vertical
/// profiles only the hits are written.
class TruthFiles {
 public:
  TruthFiles(const std::filesystem::path& prefix, const simulation::Outline& stationary_in_world,
             HitsFile hits);

  void add(const simulation::SimulatedScan& drive);

  /// Closes the files. Returns the reason if they are incomplete.
  std::optional<std::string> close();

  const std::filesystem::path& tum() const { return tum_path_; }
  const std::filesystem::path& objects() const { return objects_path_; }
  const std::filesystem::path& walls() const { return walls_path_; }
  double distance_m() const { return distance_m_; }

 private:
  simulation::SimulatedScan with_all_scanners(const simulation::SimulatedScan& drive);
  void write_newest();

  std::filesystem::path tum_path_;
  std::filesystem::path objects_path_;
  std::filesystem::path walls_path_;
  std::ofstream tum_;
  std::ofstream objects_;
  std::ofstream walls_;
  std::optional<std::ofstream> hits_;
  std::map<std::size_t, std::map<int, int>> points_by_scanner_;  // and object, of the latest scan
  std::map<int, std::int64_t> last_hit_ns_;                      // by object
  std::optional<simulation::SimulatedScan> newest_;  // pending: another scanner may have the same
                                                     // stamp
  std::optional<geometry::Pose2> last_;
  double distance_m_ = 0.0;
};

}  // namespace slammot::simulator
