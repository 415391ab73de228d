#include "services/evaluator/result_of_record.hpp"

#include <algorithm>

namespace slammot::evaluator {
namespace {

metrics::Trajectory trajectory_of(const std::vector<files::StampedPose>& poses) {
  metrics::Trajectory trajectory;
  trajectory.reserve(poses.size());
  for (const files::StampedPose& pose : poses)
    trajectory.push_back({pose.stamp_ns, pose.map_from_base});
  std::ranges::stable_sort(trajectory, {}, &metrics::StampedPose::stamp_ns);
  return trajectory;
}

ResultTrack track_of(const files::TrackRow& row) {
  ResultTrack track;
  track.stamp_ns = row.stamp_ns;
  track.track_id = row.track_id.value;
  track.map_from_object = row.map_from_object;
  track.velocity_in_map_mps = row.velocity_in_map_mps;
  track.length_m = row.length_m;
  track.width_m = row.width_m;
  track.existence = row.existence;
  track.is_moving = row.motion == flow::Motion::kMoving;
  track.is_occluded = row.occluded;
  track.object_class = files::name_of(row.object_class);
  track.position_covariance_m2 = row.covariance_in_map.topLeftCorner<2, 2>();
  track.mode_probability = row.mode_probability;
  return track;
}

}  // namespace

files::Result<RunResult> result_of(const files::RunRecord& record,
                                   const std::filesystem::path& folder) {
  RunResult result;
  result.online = trajectory_of(record.online_trajectory());
  result.corrected = trajectory_of(record.corrected_trajectory());
  if (result.online.empty()) return files::Error{"no scan was localized"};
  for (const files::UncertainStampedPose& pose : record.uncertain_poses())
    result.uncertain.push_back({pose.stamp_ns, pose.odom_from_base});
  for (const files::TrackRow* row : record.track_rows()) {
    if (result.tracks.empty() || result.tracks.back().stamp_ns != row->stamp_ns)
      result.tracks.push_back({row->stamp_ns, {}});
    result.tracks.back().tracks.push_back(track_of(*row));
  }
  if (auto fault = read_small_files(folder, result)) return *fault;
  return result;
}

}  // namespace slammot::evaluator
