#include "services/evaluator/result_of_record.hpp"

#include <algorithm>

#include "services/evaluator/drive_data.hpp"

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

void add_tracks(const std::vector<const files::TrackRow*>& rows, RunResult& result) {
  result.track_rows = rows.size();
  auto row = rows.begin();
  for (const std::size_t scan : shown_scans(result.corrected, rows.size())) {
    const std::int64_t stamp_ns = result.corrected[scan].stamp_ns;
    while (row != rows.end() && (*row)->stamp_ns < stamp_ns) ++row;
    if (row == rows.end() || (*row)->stamp_ns != stamp_ns) continue;
    result.tracks.push_back({stamp_ns, {}});
    for (; row != rows.end() && (*row)->stamp_ns == stamp_ns; ++row)
      result.tracks.back().tracks.push_back(track_of(**row));
  }
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
  add_tracks(record.track_rows(), result);
  if (auto fault = read_small_files(folder, result)) return *fault;
  return result;
}

}  // namespace slammot::evaluator
