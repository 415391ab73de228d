#pragma once

#include <vector>

#include "common/simulation/path.hpp"
#include "common/simulation/street_plan.hpp"

namespace slammot::simulation {

/// Who a lane is for: motor vehicles drive beside the centre line, bicycles between them and the
/// parked cars.
enum class RoadUser : int { motor = 0, bicycle = 1 };
enum class LaneKind { street, turn };
enum class TurnKind { straight, left, right };

/// A stretch of way that one direction of traffic follows: along a street up to the stop line, or
/// across a junction.
struct Lane {
  Path path_in_world;
  LaneKind kind = LaneKind::street;
  TurnKind turn = TurnKind::straight;  ///< Of a turn lane.
  RoadUser user = RoadUser::motor;
  int junction = -1;                   ///< Street: the one it leads to. Turn: the one it crosses.
  Direction travel = Direction::east;  ///< Direction in which it starts.
  double speed_limit_mps = 0.0;
  std::vector<int> next;       ///< Lanes that start where this one ends.
  std::vector<int> siblings;   ///< Of a turn lane: all that start where it does, itself too.
  std::vector<int> conflicts;  ///< Turn lanes that must not be used at the same time.
};

/// All lanes of a city. Right-hand traffic.
class RoadNetwork {
 public:
  explicit RoadNetwork(const StreetPlan& plan, double speed_limit_mps = 12.5);

  const std::vector<Lane>& lanes() const { return lanes_; }
  const Lane& lane(int index) const { return lanes_[static_cast<std::size_t>(index)]; }
  /// Street lane that leaves a junction in a direction; -1 where no street does.
  int street_lane(RoadUser user, int junction, Direction direction) const;

 private:
  void add_street_lanes(const StreetPlan& plan, RoadUser user);
  void add_turn_lanes(const StreetPlan& plan, RoadUser user);
  void find_conflicts();

  double speed_limit_mps_;
  std::vector<Lane> lanes_;
  std::vector<int> street_lanes_;  ///< By user, junction and direction.
};

}  // namespace slammot::simulation
