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
  std::vector<metrics::TrueObject> hidden = {};  ///< Objects whose rows have no points.
};

/// What the beams of one scan hit, run-length encoded.
struct HitsAt {
  struct Run {
    metrics::BeamHit hit;
    std::size_t beams = 0;
  };
  std::int64_t stamp_ns = 0;
  std::vector<Run> runs;

  std::vector<metrics::BeamHit> hits() const;  ///< One a beam.
};

/// Ground truth of a drive. Members without a file are empty.
struct Truth {
  metrics::Trajectory trajectory;                 ///< world_from_base.
  std::optional<std::vector<ObjectsAt>> objects;  ///< Ascending stamps.
  std::size_t object_count = 0;
  std::optional<std::vector<metrics::WallSegment>> walls;
  std::optional<std::vector<HitsAt>> hits;          ///< Of the first scanner; ascending stamps.
  std::optional<std::vector<ObjectsAt>> annotated;  ///< Manual annotations of people in the laser's
                                                    ///< frame, at some scans. Excludes trajectory
                                                    ///< and objects.
  std::optional<metrics::Trajectory> other_car;     ///< Motion capture of a second car.
  std::vector<std::string> read;                    ///< Names of the files read.
};

/// Reads lines "stamp x y z qx qy qz qw" and sorts them by stamp.
files::Result<metrics::Trajectory> read_tum(const std::filesystem::path& path);

/// Reads PREFIX.tum, .objects.csv, .hits.csv and .walls.csv, each plain or .gz; otherwise
/// PREFIX.ego.tum and .red.tum (motion capture of two cars); otherwise PREFIX.reference.txt (lines
/// "index stamp x y heading"). Only the trajectory is required. Of a folder, reads people_gt.txt
/// only (lines "stamp person x y").
files::Result<Truth> read_truth(const std::filesystem::path& prefix);

}  // namespace slammot::evaluator
