#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/files/map_image.hpp"
#include "common/files/result.hpp"
#include "common/metrics/scene.hpp"
#include "common/metrics/trajectory.hpp"
#include "common/traffic/way.hpp"
#include "services/evaluator/result_graph.hpp"

namespace slammot::evaluator {

/// A row of tracks.csv and of track_details.csv, if there is one; in map.
struct ResultTrack {
  std::int64_t stamp_ns = 0;
  std::uint32_t track_id = 0;
  geometry::Pose2 map_from_object;
  geometry::Vector2 velocity_in_map_mps = geometry::Vector2::Zero();
  double length_m = 0.0;
  double width_m = 0.0;
  double existence = 1.0;  ///< Column `existence`; 1 if it is absent.
  bool is_moving = true;
  bool is_occluded = false;  ///< Column `occluded`; false if it is absent.
  std::string object_class;
  std::optional<geometry::Matrix2> position_covariance_m2;
  std::optional<geometry::Matrix2> velocity_covariance_m2ps2;
  std::vector<double> mode_probability;  ///< Of each motion model; empty if not written.
  std::vector<metrics::PredictedPlace> predicted_in_map;  ///< From predictions.csv, if there is
                                                          ///< one.
};

struct TracksAt {
  std::int64_t stamp_ns = 0;
  std::vector<ResultTrack> tracks;
};

/// A row of labels.csv. One letter a beam: 's' stationary, 'm' moving, '?' unknown, '-' no echo.
struct LabelsAt {
  std::int64_t stamp_ns = 0;
  std::string by_detection;
  std::string by_tracking;
};

/// Time in which scans did not match the map.
struct LostSpan {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

/// Output of `slammot run` or `bench`.
struct RunResult {
  metrics::Trajectory online;     ///< map_from_base as published live; never empty.
  metrics::Trajectory corrected;  ///< After the last correction; never empty.
  std::vector<metrics::UncertainStampedPose> uncertain;  ///< Empty if not written.
  std::vector<TracksAt> tracks;  ///< Ascending stamps; without scans that have no tracks.
  std::size_t track_rows = 0;    ///< Of the drive, where `tracks` holds only a part; else 0.
  std::vector<LabelsAt> labels;  ///< Ascending stamps; empty if not written.
  std::optional<files::MapImage> map;
  std::optional<files::MapImage> moving;          ///< MO-map; the same pixels as `map`.
  std::optional<std::vector<traffic::Way>> ways;  ///< lanes.geojson; none if not written.
  ResultGraph graph;
  std::vector<LostSpan> losses;
  std::string report_json;          ///< Text of report.json; may be empty.
  geometry::Pose2 base_from_laser;  ///< As used by the run.
  double sweep_s = 0.0;  ///< Time from the first beam of a scan to its last, as used by the run; 0
                         ///< if unknown.
};

files::Result<RunResult> read_result(const std::filesystem::path& folder);

/// Maps, lanes and graph of a folder without a drive, as `map merge` writes it: the trajectories of
/// the result are empty. Fails without map.yaml.
files::Result<RunResult> read_map_folder(const std::filesystem::path& folder);

/// Reads graph, maps and figures of a result, not its tables. Times of losses need its
/// trajectories.
std::optional<files::Error> read_small_files(const std::filesystem::path& folder,
                                             RunResult& result);

/// An image written by map_image: NAME.pgm and NAME.yaml.
files::Result<files::MapImage> read_map(const std::filesystem::path& yaml);

}  // namespace slammot::evaluator
