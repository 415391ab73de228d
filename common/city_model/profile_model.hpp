#pragma once

#include <cstdint>
#include <vector>

#include "common/city_model/facades.hpp"
#include "common/city_model/mover_boxes.hpp"
#include "common/city_model/road_height.hpp"
#include "common/metrics/map_quality.hpp"
#include "common/metrics/trajectory.hpp"
#include "common/sensing/scan.hpp"
#include "common/sensing/spatial_mounting.hpp"

namespace slammot::city_model {

/// What is estimated of a drive, known after its end.
struct EstimatedDrive {
  metrics::Trajectory online;     ///< map_from_base as published live: the frame of the movers.
  metrics::Trajectory corrected;  ///< After the last correction: the frame of the model.
  MoverBoxes movers;
  metrics::OccupancyCells stationary;  ///< SO-map; empty if there is none.
};

struct ModelConfig {
  double cell_size_m = 0.5;
  double least_height_m = 0.4;    ///< Above the road; kerbs and the road are lower.
  double longest_range_m = 60.0;  ///< Beams that are farther apart show no shape.
};

/// Echoes of a drive by what became of them.
struct ModelCounts {
  std::uint64_t scans = 0;
  std::uint64_t scans_without_pose = 0;
  std::uint64_t echoes = 0;
  std::uint64_t of_road = 0;
  std::uint64_t of_movers = 0;      ///< In the box of a track.
  std::uint64_t in_free_space = 0;  ///< In columns that the SO-map shows to be free.
};

struct CityModel {
  std::vector<PlacedEcho> points;
  std::vector<Facade> facades;
  ModelCounts counts;
};

/// 2.5-D model of a city from the vertical profiles of a drive (Wang 2004, Section 6.5): each echo
/// is placed by the trajectory at the time of its beam; the road and what moves are left out;
/// columns of the plan become facades. Roll and pitch of the vehicle are not known.
class ProfileModel {
 public:
  /// `drive` must outlive it.
  ProfileModel(const EstimatedDrive& drive, const ModelConfig& config)
      : drive_(drive), config_(config) {}

  /// Call with ascending stamps.
  void add(const sensing::LaserScan& scan, const sensing::SpatialMounting& mounting);

  CityModel finish();

 private:
  struct ScanPoses;

  void place(const sensing::LaserScan& scan, const ScanPoses& poses);
  bool is_free(const std::vector<PlacedEcho>& column) const;
  void leave_out_free_space();

  const EstimatedDrive& drive_;
  ModelConfig config_;
  RoadHeight road_;
  Columns columns_;
  ModelCounts counts_;
  std::vector<Eigen::Vector3d> points_in_base_m_;  ///< Echoes of the scan; reused.
  std::vector<std::uint16_t> beams_;               ///< Theirs.
};

}  // namespace slammot::city_model
