#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/traffic/traffic_map.hpp"

namespace slammot::traffic {

/// What moved while one submap was in use, and where the submap lies.
struct PlacedTraffic {
  std::shared_ptr<const std::vector<FreeStream>> streams;  ///< In the submap's frame.
  geometry::Pose2 map_from_submap;
};

/// Sums the streams of submaps in map.
TrafficMap traffic_in_map(const std::vector<PlacedTraffic>& parts);

/// The moving-object map of one map: streams by submap, which follow the submaps when loop closing
/// moves them. Memory is bounded: beyond the greatest number of streams, those of the earliest
/// submaps are left out.
class MapTraffic {
 public:
  explicit MapTraffic(std::size_t most_streams = 400'000) : most_streams_(most_streams) {}

  /// Adds to what the submap has.
  void add(flow::SubmapId submap_id, std::vector<FreeStream> streams);

  /// Places submaps of the correction. As long as the graph's newest submap is untied, submaps
  /// that were never placed stay unplaced: their poses are arbitrary.
  void place(const flow::GraphCorrection& correction);

  /// Streams of all placed submaps.
  std::vector<PlacedTraffic> placed() const;

  /// True if streams were added or moved by more than centimetres since the last call.
  bool take_change();

  std::size_t size() const { return streams_; }
  std::size_t submaps() const { return parts_.size(); }
  std::size_t left_out() const { return left_out_; }  ///< Submaps.

 private:
  struct Part {
    std::shared_ptr<const std::vector<FreeStream>> streams;
    std::optional<geometry::Pose2> told_pose{};  ///< Of the last change.
  };

  void forget_earliest();

  std::size_t most_streams_;
  std::size_t streams_ = 0;
  std::size_t left_out_ = 0;
  std::map<flow::SubmapId, Part> parts_;
  std::map<flow::SubmapId, geometry::Pose2> map_from_submap_;
  bool has_changed_ = false;
};

}  // namespace slammot::traffic
