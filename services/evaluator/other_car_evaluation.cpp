#include "services/evaluator/other_car_evaluation.hpp"

#include <cstdint>
#include <optional>
#include <set>

namespace slammot::evaluator {

OtherCarEvaluation evaluate_other_car(const std::vector<metrics::Scene>& scenes,
                                      const metrics::Trajectory& other_car) {
  constexpr double kGateM = 0.5;  // about the length of such a car
  constexpr std::int64_t kLongestTruthGapNs = 200'000'000;
  constexpr std::int64_t kDifferenceNs = 50'000'000;  // averages millimetres of noise of motion
                                                      // capture
  OtherCarEvaluation evaluation;
  std::vector<double> position_m;
  std::vector<double> velocity_mps;
  std::set<std::size_t> identities;
  std::optional<std::size_t> track_before;
  std::size_t false_tracks = 0;
  for (const metrics::Scene& scene : scenes) {
    const auto now = metrics::pose_at(other_car, scene.stamp_ns, kLongestTruthGapNs);
    const auto before =
        metrics::pose_at(other_car, scene.stamp_ns - kDifferenceNs, kLongestTruthGapNs);
    const auto after =
        metrics::pose_at(other_car, scene.stamp_ns + kDifferenceNs, kLongestTruthGapNs);
    if (!now || !before || !after) continue;
    ++evaluation.scans;
    const metrics::ReportedTrack* match = nullptr;
    const auto away_m = [&](const metrics::ReportedTrack& track) {
      return (track.world_from_object.translation_m() - now->translation_m()).norm();
    };
    for (const metrics::ReportedTrack& track : scene.tracks) {
      if (away_m(track) > kGateM) continue;
      const bool continues = track_before && track.track == *track_before;
      if (!match || continues || (match->track != track_before && away_m(track) < away_m(*match)))
        match = &track;
    }
    for (const metrics::ReportedTrack& track : scene.tracks)
      false_tracks += track.is_moving && &track != match ? 1 : 0;
    if (!match) continue;
    ++evaluation.matched_scans;
    track_before = match->track;
    identities.insert(match->track);
    position_m.push_back(away_m(*match));
    const geometry::Vector2 true_velocity_mps = (after->translation_m() - before->translation_m()) /
                                                (2e-9 * static_cast<double>(kDifferenceNs));
    velocity_mps.push_back((match->velocity_in_world_mps - true_velocity_mps).norm());
  }
  evaluation.identities = identities.size();
  evaluation.position_m = metrics::summarize(position_m);
  evaluation.velocity_mps = metrics::summarize(velocity_mps);
  if (evaluation.scans > 0)
    evaluation.false_moving_tracks_a_scan =
        static_cast<double>(false_tracks) / static_cast<double>(evaluation.scans);
  return evaluation;
}

}  // namespace slammot::evaluator
