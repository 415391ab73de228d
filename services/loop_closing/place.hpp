#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/flow/submap.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::loop_closing {

/// What a submap knows about a spot; the greater one outweighs the other.
enum class Spot : std::uint8_t { kUnknown, kFree, kOccupied };

/// What loop closing keeps of a submap: its walls, thinned, and for every cell whether it was free
/// or occupied.
struct Place {
  flow::SubmapId id;
  double travelled_before_m = 0.0;  ///< By the vehicle, when the submap began,
  double travelled_after_m = 0.0;   ///< and when it ended.
  geometry::Pose2 odom_from_submap;
  geometry::Vector2 middle_m;  ///< Of the way driven, in the submap's frame.
  std::vector<flow::Surfel> surfels;
  double spacing_m = 0.0;  ///< Between neighbouring surfels.
  double cell_size_m = 0.0;
  double min_x_m = 0.0;
  double min_y_m = 0.0;
  std::int32_t columns = 0;
  std::int32_t rows = 0;
  std::vector<Spot> spots;  ///< Row-major; occupied cells are widened by the tolerance.

  Spot spot_at(const geometry::Vector2& point_in_submap_m) const;
};

struct PlaceConfig {
  double tolerance_m = 0.4;  ///< A wall this far off still is that wall.
};

/// travelled_before_m: by the vehicle, in all the submaps before this one.
Place make_place(const flow::Submap& submap, double travelled_before_m, const PlaceConfig& config);

/// Earlier places taken as one target, in the frame of the first of them.
struct Target {
  struct Member {
    const Place* place = nullptr;
    geometry::Pose2 target_from_member;
  };
  std::vector<Member> members;  ///< The first one is the target itself, at identity.
};

/// How well a place agrees with a target about what both have seen.
struct Agreement {
  int occupied_in_both = 0;  ///< Walls of either that the other has too.
  int contradicted = 0;      ///< A wall to one, free to the other.
  int source_in_target = 0;  ///< Walls of the source that the target has too.
  int source_walls = 0;

  double agreed_share() const {
    return static_cast<double>(occupied_in_both) / std::max(occupied_in_both + contradicted, 1);
  }
  double overlap_share() const {
    return static_cast<double>(source_in_target) / std::max(source_walls, 1);
  }
};

/// Asks each side about the other's walls: what a false closure almost always gets wrong is what
/// ought to be free.
Agreement compare(const Target& target, const Place& source,
                  const geometry::Pose2& target_from_source);

}  // namespace slammot::loop_closing
