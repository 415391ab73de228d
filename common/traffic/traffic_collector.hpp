#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/flow/submap.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/traffic/mover_evidence.hpp"
#include "common/traffic/traffic_map.hpp"

namespace slammot::traffic {

/// Collects what moves during a drive, in its frame odom, and hands over what moved while a submap
/// was in use. Tracks that live longer than the submap are split. Memory is bounded: by the number
/// of tracks, of states a track, and of streams.
class TrafficCollector {
 public:
  /// Takes confirmed objects that move and are seen. Another map or another frame odom discards
  /// everything; a stamp that was taken already is ignored.
  void add(const flow::TrackedObjects& objects);

  /// Streams of what moved until the end of the submap and was not taken before, in the submap's
  /// frame. None for a submap of another map, or one that ended before all of it.
  std::vector<FreeStream> take(const flow::Submap& submap);

  /// Of tracks that ended, or are long, and were not taken; in odom.
  std::vector<FreeStream> waiting() const { return streams_.free_streams({}); }
  /// Increases with each part of a track that waits.
  std::uint32_t parts() const { return parts_; }

  static constexpr std::size_t kMostTracks = 1024;
  static constexpr std::size_t kMostStates = 256;      ///< Of one track, at least 0.25 m apart.
  static constexpr std::size_t kMostStreams = 50'000;  ///< Of one submap.

 private:
  struct Track {
    std::vector<MoverState> states{};  ///< That are in no stream; the first one joins them to it.
    MoverEvidence kind;
    double width_sum_m = 0.0;
    double scans = 0.0;
    std::optional<geometry::Vector2> first_m{};
    bool went_somewhere = false;
    std::int64_t last_stamp_ns = 0;
  };

  void add(const flow::TrackedObject& object, Track& track);
  void extend(const MoverState& state, Track& track);
  void settle(Track& track, std::int64_t until_ns);
  void end_tracks(std::int64_t before_ns);

  flow::MapId map_id_;
  flow::OdomId odom_id_;
  std::int64_t stamp_ns_ = 0;
  std::map<flow::TrackId, Track> tracks_;
  TrafficMap streams_{kMostStreams};  ///< In odom.
  std::uint32_t parts_ = 0;
  std::optional<std::int64_t> streams_begin_ns_;  ///< Stamp of the first state in them.
};

}  // namespace slammot::traffic
