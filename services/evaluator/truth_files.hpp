#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/detection.hpp"
#include "common/metrics/map_quality.hpp"
#include "common/metrics/scene.hpp"
#include "common/metrics/trajectory.hpp"

namespace slammot::evaluator {

struct ObjectsAt {
  std::int64_t stamp_ns = 0;
  std::vector<metrics::TrueObject> objects;
};

/// What the beams of one scan hit, runs of the same together.
struct HitsAt {
  struct Run {
    metrics::BeamHit hit;
    std::size_t beams = 0;
  };
  std::int64_t stamp_ns = 0;
  std::vector<Run> runs;

  std::vector<metrics::BeamHit> hits() const;  ///< One a beam.
};

/// What truly happened in a drive, as far as there are files of it.
struct Truth {
  metrics::Trajectory trajectory;                 ///< world_from_base.
  std::optional<std::vector<ObjectsAt>> objects;  ///< Ascending stamps.
  std::size_t object_count = 0;
  std::optional<std::vector<metrics::WallSegment>> walls;
  std::optional<std::vector<HitsAt>> hits;          ///< Of the first scanner; ascending stamps.
  std::optional<std::vector<ObjectsAt>> annotated;  ///< People marked by hand, now and then, in the
                                                    ///< frame of the laser: where there are such,
                                                    ///< there is no trajectory and there are no
                                                    ///< objects.
  std::optional<metrics::Trajectory> other_car;     ///< Motion capture of a second car.
  std::vector<std::string> read;                    ///< File names.
};

/// "stamp x y z qx qy qz qw" a line, by ascending stamps after reading.
files::Result<metrics::Trajectory> read_tum(const std::filesystem::path& path);

/// Reads PREFIX.tum, .objects.csv, .hits.csv and .walls.csv, each plain or .gz; else PREFIX.ego.tum
/// and .red.tum (motion capture of two cars); else PREFIX.reference.txt ("index stamp x y heading"
/// a line). Only the trajectory must exist. Of a folder people_gt.txt ("stamp person x y" a line)
/// is read: annotations and nothing else.
files::Result<Truth> read_truth(const std::filesystem::path& prefix);

}  // namespace slammot::evaluator
