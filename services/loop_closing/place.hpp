#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/flow/submap.hpp"
#include "common/geometry/geodetic.hpp"
#include "common/geometry/pose2.hpp"
#include "services/loop_closing/cell_states.hpp"

namespace slammot::loop_closing {

/// The part of a submap that loop closing keeps: surfels of walls, and a grid of free and occupied
/// cells.
struct Place {
  flow::SubmapId id;
  double travelled_before_m = 0.0;  ///< Distance driven until the submap begins.
  double travelled_after_m = 0.0;   ///< Distance driven until the submap ends.
  geometry::Pose2 odom_from_submap;
  std::optional<geometry::Geodetic> by_gnss{};  ///< Median of the fixes; none with few of them.
  geometry::Vector2 centre_m;  ///< Midpoint of the trajectory, in the submap's frame.
  std::vector<flow::Surfel> surfels;
  double cell_size_m = 0.0;
  double min_x_m = 0.0;
  double min_y_m = 0.0;
  CellStates cells;            ///< Occupied cells are dilated by the tolerance.
  bool is_superseded = false;  ///< Later places show the same: no target, without surfels and
                               ///< cells.

  CellState state_at(const geometry::Vector2& point_in_submap_m) const;
};

using Places = std::map<flow::SubmapId, Place>;

struct PlaceConfig {
  double tolerance_m = 0.4;  ///< Walls of two submaps within this distance agree.
};

/// `travelled_before_m`: distance driven in all submaps before this one.
Place make_place(const flow::Submap& submap, double travelled_before_m, const PlaceConfig& config);

/// Earlier places as one target, in the frame of the first member.
struct Target {
  struct Member {
    const Place* place = nullptr;
    geometry::Pose2 target_from_member;
  };
  std::vector<Member> members;  ///< The first member is the target itself, at identity.
};

/// Frees the memory of a place that is no target any more.
void supersede(Place& place);

/// Surfels of all members, in the target's frame.
std::vector<flow::Surfel> surfels_in_target(const Target& target);

/// Agreement of a place with a target where both have seen something [surfels].
struct Agreement {
  int occupied_in_both = 0;  ///< Walls of either that the other has too.
  int contradicted = 0;      ///< Walls of one in free space of the other.
  int source_in_target = 0;  ///< Walls of the source that the target has too.
  int source_walls = 0;

  double agreed_share() const {
    return static_cast<double>(occupied_in_both) / std::max(occupied_in_both + contradicted, 1);
  }
  double overlap_share() const {
    return static_cast<double>(source_in_target) / std::max(source_walls, 1);
  }
};

/// Compares the walls of each side with the grid of the other. Free space is decisive: a false
/// closure almost always puts walls into it.
Agreement compare(const Target& target, const Place& source,
                  const geometry::Pose2& target_from_source);

}  // namespace slammot::loop_closing
