#include "common/traffic/traffic_collector.hpp"

#include <algorithm>
#include <utility>

namespace slammot::traffic {
namespace {

constexpr std::int64_t kLongestGapNs = static_cast<std::int64_t>(kLongestGapS * 1e9);
constexpr double kLongestStepM = 60.0;  // within the longest gap; a farther one is a fault

}  // namespace

void TrafficCollector::add(const flow::TrackedObjects& objects) {
  if (objects.map_id != map_id_ || objects.odom_id != odom_id_) {
    const std::uint32_t parts = parts_;
    *this = TrafficCollector();
    parts_ = parts;
    map_id_ = objects.map_id;
    odom_id_ = objects.odom_id;
  } else if (objects.stamp_ns <= stamp_ns_) {
    if (objects.stamp_ns == stamp_ns_) return;
    end_tracks(stamp_ns_ + 1);  // the source's clock was set back
  }
  stamp_ns_ = objects.stamp_ns;
  for (const flow::TrackedObject& object : objects.objects) {
    if (!object.confirmed || object.occluded || object.motion != flow::Motion::kMoving) continue;
    if (tracks_.size() >= kMostTracks && !tracks_.contains(object.track_id)) continue;
    Track& track = tracks_[object.track_id];
    track.last_stamp_ns = stamp_ns_;
    add(object, track);
    if (track.states.size() >= kMostStates) settle(track, stamp_ns_);
  }
  end_tracks(stamp_ns_ - kLongestGapNs);
}

void TrafficCollector::add(const flow::TrackedObject& object, Track& track) {
  track.kind.add(object.class_probability);
  track.width_sum_m += object.width_m;
  track.scans += 1.0;
  const MoverState state{stamp_ns_, object.position_in_odom_m, object.velocity_in_odom_mps,
                         object.covariance};
  if (moves(state) && state.position_in_map_m.cwiseAbs().maxCoeff() < kFarthestM)
    extend(state, track);
}

void TrafficCollector::extend(const MoverState& state, Track& track) {
  if (!track.states.empty()) {
    const double step_m = (state.position_in_map_m - track.states.back().position_in_map_m).norm();
    if (step_m < kPieceM) return;
    if (step_m > kLongestStepM) {
      settle(track, stamp_ns_);
      track.states.clear();
    }
  }
  if (!track.first_m) track.first_m = state.position_in_map_m;
  track.went_somewhere =
      track.went_somewhere || (state.position_in_map_m - *track.first_m).norm() >= kLeastWayM;
  track.states.push_back(state);
}

/// Makes streams of the track's states until then. What has not gone far yet waits.
void TrafficCollector::settle(Track& track, std::int64_t until_ns) {
  const auto kind = track.kind.likeliest();
  if (!kind || !track.went_somewhere) {
    if (track.states.size() >= kMostStates)
      track.states.erase(track.states.begin(), track.states.end() - 1);
    return;
  }
  const auto end = std::ranges::find_if(
      track.states, [&](const MoverState& state) { return state.stamp_ns > until_ns; });
  if (end - track.states.begin() < 2) return;
  streams_begin_ns_ = std::min(streams_begin_ns_.value_or(track.states.front().stamp_ns),
                               track.states.front().stamp_ns);
  streams_.add_part({*kind, track.width_sum_m / track.scans, {track.states.begin(), end}});
  track.states.erase(track.states.begin(), end - 1);
  ++parts_;
}

void TrafficCollector::end_tracks(std::int64_t before_ns) {
  for (auto item = tracks_.begin(); item != tracks_.end();) {
    Track& track = item->second;
    if (track.last_stamp_ns >= before_ns) {
      ++item;
      continue;
    }
    settle(track, track.last_stamp_ns);
    item = tracks_.erase(item);
  }
}

std::vector<FreeStream> TrafficCollector::take(const flow::Submap& submap) {
  if (submap.map_id != map_id_) return {};
  if (streams_begin_ns_ && *streams_begin_ns_ > submap.last_stamp_ns) return {};
  for (auto& [id, track] : tracks_) settle(track, submap.last_stamp_ns);
  streams_begin_ns_.reset();
  return std::exchange(streams_, TrafficMap(kMostStreams))
      .free_streams(inverse(submap.odom_from_submap));
}

}  // namespace slammot::traffic
