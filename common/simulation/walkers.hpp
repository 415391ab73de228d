#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/simulation/moving_object.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/street_plan.hpp"

namespace slammot::simulation {

struct WalkersConfig {
  int pedestrians = 60;
  double speed_mps = 1.35;            ///< Mean; people differ by `speed_sigma_mps`.
  double speed_sigma_mps = 0.25;
  double runner_share = 0.03;
  double pair_share = 0.3;            ///< Of the groups: two side by side.
  double trio_share = 0.08;
  double pause_every_s = 60.0;        ///< Mean time between pauses.
  double pause_s = 6.0;               ///< Longest pause.
  double sideways_m = 0.5;            ///< People keep up to this far from the middle of the way,
  double step_aside_m = 0.75;         ///< and step this far to their right to let a vehicle pass.
};

/// Crossing of the street that leaves a junction in a direction.
struct Crossing {
  int junction = 0;
  Direction arm = Direction::east;
};

/// Places and the straight ways between them that people walk.
struct WalkGraph {
  struct Way {
    int to = 0;
    std::optional<Crossing> crossing;
  };
  std::vector<geometry::Vector2> places_in_world;
  std::vector<std::vector<Way>> ways;  ///< By place.

  int add_place(const geometry::Vector2& place_in_world);
  void connect(int a, int b, std::optional<Crossing> crossing = std::nullopt);
};

/// Pavements on both sides of every street, and crossings at every junction.
WalkGraph pavements(const StreetPlan& plan);

/// Someone in the way of traffic.
struct PersonOnRoad {
  geometry::Vector2 position_in_world;
  geometry::Vector2 velocity_in_world_mps;
};

/// What people see of the traffic before and while they cross.
struct StreetView {
  std::function<bool(const Crossing&)> may_start;                          ///< Signal or gap allows it.
  std::function<bool(const geometry::Vector2& place_in_world)> is_occupied;  ///< A vehicle stands or passes here.
};

/// People who wander over a walk graph alone or in groups, pause, wait at crossings and cross.
class Walkers {
 public:
  Walkers(WalkGraph graph, const WalkersConfig& config, std::uint64_t seed);

  /// Moves everybody on by dt_s.
  void advance(double dt_s, const StreetView& street);

  /// Everybody, ids from first_id on, always in the same order.
  std::vector<MovingObject> objects(int first_id) const;
  std::vector<PersonOnRoad> on_road() const;

 private:
  struct Group {
    geometry::Vector2 position_in_world;
    geometry::Vector2 sideways_in_world;  ///< This group's place beside the middle of every way.
    double heading_rad = 0.0;
    double speed_mps = 0.0;               ///< Now.
    double walking_speed_mps = 0.0;
    double pause_left_s = 0.0;
    double blocked_s = 0.0;               ///< Held up by vehicles of late.
    double phase_rad = 0.0;
    int from = 0;
    WalkGraph::Way way;
    bool waits_to_cross = false;
    std::vector<geometry::Vector2> members_in_group;
  };

  Group make_group(int members);
  void choose_way(Group& group);
  void step_aside(Group& group, double dt_s) const;
  static bool vehicle_ahead(const Group& group, const StreetView& street);
  void advance(Group& group, double dt_s, const StreetView& street);

  WalkGraph graph_;
  WalkersConfig config_;
  Random random_;
  std::vector<Group> groups_;
};

}  // namespace slammot::simulation
