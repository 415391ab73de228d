#include "services/evaluator/scenes.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "common/files/text.hpp"
#include "services/evaluator/stamps.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using files::text;
using geometry::Pose2;
using metrics::Scene;

/// Greater than the range of any scanner.
constexpr double kMaxDistanceM = 500.0;

metrics::ReportedTrack in_world(const ResultTrack& track, std::size_t index,
                                const Pose2& world_from_map) {
  metrics::ReportedTrack reported;
  reported.track = index;
  reported.object_class = track.object_class;
  reported.world_from_object = world_from_map * track.map_from_object;
  const geometry::Matrix2 turn = geometry::rotation(world_from_map.heading_rad);
  reported.velocity_in_world_mps = turn * track.velocity_in_map_mps;
  reported.length_m = track.length_m;
  reported.width_m = track.width_m;
  reported.is_moving = track.is_moving;
  if (track.position_covariance_m2)
    reported.position_covariance_m2 = turn * *track.position_covariance_m2 * turn.transpose();
  for (const metrics::PredictedPlace& place : track.predicted_in_map)
    reported.predicted.push_back({place.after_s, world_from_map * place.position_m,
                                  turn * place.covariance_m2 * turn.transpose()});
  return reported;
}

}  // namespace

Scenes make_scenes(const RunResult& result, const Truth& truth, std::int64_t max_difference_ns) {
  constexpr std::int64_t kLongestTruthGapNs = 200'000'000;
  Scenes made;
  std::map<std::uint32_t, std::size_t> index_of_track;
  for (const metrics::StampedPose& online : result.online) {
    const auto world_from_base =
        metrics::pose_at(truth.trajectory, online.stamp_ns, kLongestTruthGapNs);
    if (!world_from_base) continue;
    Scene scene{online.stamp_ns, *world_from_base, {}, {}};
    if (truth.objects) {
      if (const ObjectsAt* at =
              at_stamp(*truth.objects, online.stamp_ns, std::min(max_difference_ns, kSameStampNs)))
        scene.objects = at->objects, scene.hidden_objects = at->hidden;
    }
    const Pose2 world_from_map = *world_from_base * geometry::inverse(online.pose);
    if (const TracksAt* at = at_stamp(result.tracks, online.stamp_ns, kSameStampNs)) {
      for (const ResultTrack& track : at->tracks) {
        const auto [known, is_new] =
            index_of_track.try_emplace(track.track_id, index_of_track.size());
        if (is_new) made.track_ids.push_back(track.track_id);
        const std::size_t index = known->second;
        (track.is_occluded ? scene.occluded_tracks : scene.tracks)
            .push_back(in_world(track, index, world_from_map));
      }
    }
    made.scenes.push_back(std::move(scene));
  }
  return made;
}

std::optional<Error> fault_of_objects(const std::vector<Scene>& scenes, bool has_objects) {
  double nearest_object_m = std::numeric_limits<double>::infinity();
  double nearest_track_m = std::numeric_limits<double>::infinity();
  bool has_rows = false;
  bool has_tracks = false;
  for (const Scene& scene : scenes) {
    const auto away_m = [&](const Pose2& pose) {
      return (pose.translation_m() - scene.world_from_base.translation_m()).norm();
    };
    for (const auto& object : scene.objects)
      nearest_object_m = std::min(nearest_object_m, away_m(object.world_from_object));
    for (const auto& track : scene.tracks)
      nearest_track_m = std::min(nearest_track_m, away_m(track.world_from_object));
    has_rows = has_rows || !scene.objects.empty();
    has_tracks = has_tracks || !scene.tracks.empty();
  }
  if (has_objects && !has_rows)
    return Error{"the clocks do not overlap: no scan of the result has true objects at its time"};
  if (has_rows && nearest_object_m > kMaxDistanceM)
    return Error{text(
        "the frames do not overlap: the nearest true object is %.0f m from the true trajectory",
        nearest_object_m)};
  if (has_tracks && nearest_track_m > kMaxDistanceM)
    return Error{
        text("the frames do not overlap: the nearest track is %.0f m from the online trajectory",
             nearest_track_m)};
  return std::nullopt;
}

}  // namespace slammot::evaluator
