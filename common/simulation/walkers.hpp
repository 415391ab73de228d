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
  double speed_mps = 1.35;  ///< Mean; people differ by `speed_sigma_mps`.
  double speed_sigma_mps = 0.25;
  double runner_share = 0.03;
  double pair_share = 0.3;  ///< Of the groups: two side by side.
  double trio_share = 0.08;
  double pause_every_s = 60.0;  ///< Mean time between pauses.
  double pause_s = 6.0;         ///< Longest pause.
  double sideways_m = 0.5;      ///< People keep up to this far from the middle of the way,
  double step_aside_m = 0.75;   ///< and step this far to their right to let a vehicle pass.
};

/// Crossing of the street that leaves a junction in a direction.
struct Crossing {
  int junction = 0;
  Direction arm = Direction::east;
};

/// Places and the straight ways between them for pedestrians.
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

/// A person in the way of traffic.
struct PersonOnRoad {
  geometry::Vector2 position_in_world;
  geometry::Vector2 velocity_in_world_mps;
};

/// Traffic as pedestrians perceive it before and while they cross.
struct StreetView {
  std::function<bool(const Crossing&)> may_start;  ///< Signal or gap allows crossing.
  /// A vehicle is or will be here.
  std::function<bool(const geometry::Vector2& place_in_world)> is_occupied;
};

/// Pedestrians who walk at random over a graph, alone or in groups, pause, wait at crossings and
/// cross.
class Walkers {
 public:
  Walkers(WalkGraph graph, const WalkersConfig& config, std::uint64_t seed);

  /// Moves all pedestrians by dt_s.
  void advance(double dt_s, const StreetView& street);

  /// All pedestrians, ids from first_id on, in constant order.
  std::vector<MovingObject> objects(int first_id) const;
  std::vector<PersonOnRoad> on_road() const;

 private:
  struct Group {
    geometry::Vector2 position_in_world;
    geometry::Vector2 sideways_in_world;  ///< Lateral offset of this group from the middle of every
                                          ///< way.
    double heading_rad = 0.0;
    double speed_mps = 0.0;  ///< Current speed.
    double walking_speed_mps = 0.0;
    double pause_left_s = 0.0;
    double blocked_s = 0.0;  ///< Recent time for which vehicles blocked it.
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
