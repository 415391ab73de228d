#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/files/run_record.hpp"
#include "common/files/run_report.hpp"

namespace slammot::files {

/// One line "stamp x y z qx qy qz qw" a pose: the TUM benchmark's form, as evo and others read it.
std::string to_tum(const std::vector<StampedPose>& trajectory);

/// Header and one line a row:
/// timestamp,track_id,x,y,heading,vx,vy,length,width,motion,existence,class,occluded.
std::string to_tracks_csv(const std::vector<const TrackRow*>& rows);

/// Columns that tracks.csv lacks, row by row:
/// timestamp,track_id,var_x,cov_xy,var_y,var_vx,cov_vxy,var_vy,p_pedestrian,p_bicycle,
/// p_car,p_truck_or_bus,mode_0,mode_1,...
/// in map; as many modes as the first row has.
std::string to_track_details_csv(const std::vector<const TrackRow*>& rows);

/// Predicted positions, one line per prediction time (whole seconds):
/// timestamp,track_id,after,x,y,var_x,cov_xy,var_y in map.
std::string to_predictions_csv(const std::vector<const TrackRow*>& rows);

/// Header and one line a pose: timestamp,x,y,heading,var_x,cov_xy,cov_xh,var_y,cov_yh,var_h in
/// odom, h the heading.
std::string to_online_covariance_csv(const std::vector<UncertainStampedPose>& poses);

/// Header and one line a scan: timestamp,detection,tracking, a letter a beam.
std::string to_labels_csv(const std::vector<const LabelRow*>& rows);

/// Vertices are the submaps where they are now, edges the constraints. The information of EDGE_SE2
/// counts in the frame of the edge's end, so covariances, which count in the frame of its
/// beginning, are turned.
std::string to_g2o(const RunRecord& record);

/// Distance along the trajectory, without the noise of a standing vehicle.
double travelled_m(const std::vector<StampedPose>& trajectory);

/// Writes the part of the outputs that is about the map: graph.g2o, map.{pgm,png,yaml},
/// moving.{pgm,png,yaml} and report.json.
std::optional<Error> write_map_outputs(const std::filesystem::path& folder, const RunRecord& record,
                                       const RunReport& report);

/// Writes online.tum, online_covariance.csv, trajectory.tum, tracks.csv, track_details.csv,
/// predictions.csv, lanes.geojson, labels.csv (where there are labels), graph.g2o,
/// map.{pgm,png,yaml}, moving.{pgm,png,yaml} and report.json into the folder, which must exist.
/// Stops at the first file that cannot be written.
std::optional<Error> write_outputs(const std::filesystem::path& folder, const RunRecord& record,
                                   const RunReport& report);

}  // namespace slammot::files
