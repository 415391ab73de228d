#pragma once

#include <vector>

#include "common/simulation/moving_object.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/road_network.hpp"
#include "common/simulation/walkers.hpp"

namespace slammot::simulation {

struct TrafficConfig {
  int cars = 40;
  int trucks = 3;
  int buses = 3;
  int bicycles = 8;
  double stopping_share = 0.15;  ///< Share of cars and trucks that stop in the lane now and then
                                 ///< (delivery).
  /// Route of a stop-and-go car directly ahead of the vehicle, from its first junction on; empty:
  /// none.
  std::vector<JunctionId> car_ahead;
  double green_s = 13.0;      ///< Of each of the two axes at a signalled junction.
  double clearance_s = 3.0;   ///< Red for all after each green.
  bool varied_sizes = false;  ///< Sizes differ within each class as those on the road do; otherwise
                              ///< trucks are alike, buses are alike, and cars differ a little.
};

/// Where the vehicle goes and how it is driven.
struct RouteConfig {
  std::vector<JunctionId> junctions;  ///< Corners in sequence with straight streets between; random
                                      ///< after the last. Empty: a random route.
  double start_m = 12.0;              ///< Behind the stop line of the first junction.
  double speed_factor = 0.95;         ///< Of the limit.
  double hard_brake_every_s = 45.0;   ///< Mean time between hard brakings.
  double hard_brake_mps2 = 5.5;
  double length_m = 5.0;
  double width_m = 2.0;
};

/// Cars, trucks, buses and bicycles on a road network, and the vehicle that carries the scanners
/// among them. Followers keep their distance by the intelligent driver model (Treiber et al. 2000);
/// at junctions a turn is entered only when the signal allows it, no conflicting turn is taken and
/// there is room behind; people on crossings are waited for.
class Traffic {
 public:
  struct Setup {
    TrafficConfig traffic;
    RouteConfig route;
    std::uint64_t seed = 1;
  };
  Traffic(const StreetPlan& plan, const Setup& setup);

  void advance(double dt_s, const std::vector<PersonOnRoad>& people);
  /// True if signal or gap allows a person to start across now.
  bool may_cross(const Crossing& crossing) const;

  /// True if a vehicle's body covers the place.
  bool is_occupied(const geometry::Vector2& place_in_world) const;
  /// may_cross and is_occupied for pedestrians. Refers to this traffic, which must outlive it.
  StreetView street_view() const;

  /// The vehicle with the scanners, then all other objects; ids from 0 on, in a fixed order.
  const std::vector<MovingObject>& objects() const { return objects_; }

 private:
  struct Driver {
    ObjectClass kind = ObjectClass::car;
    RoadUser user = RoadUser::motor;
    double length_m = 4.5;
    double half_width_m = 0.9;
    double sideways_m = 0.0;  ///< Place to the left of the lane's middle.
    double speed_factor = 1.0;
    int last_lane = -1;      ///< The previous lane.
    std::vector<int> lanes;  ///< Current lane, then the lanes ahead.
    double arc_m = 0.0;      ///< Of its centre along lanes.front().
    double speed_mps = 0.0;
    double travelled_m = 0.0;
    int reserved_turn = -1;
    double stop_every_m = 0.0;  ///< Mean distance between its own stops; 0 never stops.
    double next_stop_m = 0.0;   ///< Of travelled_m.
    double stop_left_s = 0.0;
    std::vector<JunctionId> route;  ///< Junctions still to be passed, the next one first.
  };
  /// An obstacle or line to stop behind.
  struct Obstacle {
    double gap_m;
    double speed_mps;
  };

  void place_vehicle(const RouteConfig& route);
  void place_on_route(Driver& driver, const std::vector<JunctionId>& route, double arc_m);
  void place_drivers(const TrafficConfig& config);
  void place_car_ahead(const std::vector<JunctionId>& route);
  Driver make_driver(ObjectClass kind, const TrafficConfig& config);
  bool place_at_random(Driver& driver);

  void extend_plan(Driver& driver);
  int choose_turn(Driver& driver, int street_lane);
  void sort_into_lanes();

  double acceleration_mps2(Driver& driver, const std::vector<PersonOnRoad>& people);
  double follow_mps2(const Driver& driver, double limit_mps, const Obstacle& obstacle) const;
  double limit_mps(const Driver& driver, int lane) const;
  double bend_braking_mps2(const Driver& driver) const;
  /// The next on the same way.
  Obstacle leader(std::size_t index) const;
  /// Who has just taken another way through the junction and still stands in this one's way with
  /// its tail.
  Obstacle turning_off(std::size_t index) const;
  void ask_for_turn(Driver& driver);
  bool is_next_to_go(const Driver& driver) const;
  bool turn_is_free(const Driver& driver, int turn) const;
  bool has_green(int junction, Direction travel) const;
  double person_gap_m(const Driver& driver, const std::vector<PersonOnRoad>& people) const;
  double own_stop_gap_m(Driver& driver);
  void move(Driver& driver, double acceleration_mps2, double dt_s);
  bool frightened(double dt_s);
  geometry::Pose2 pose_ahead(const Driver& driver, double ahead_m) const;
  /// Where the body is when both axles are on the way: a long one cuts corners instead of swinging
  /// out of its lane.
  geometry::Pose2 pose_on_axles(const Driver& driver) const;
  void publish();

  StreetPlan plan_;
  RoadNetwork network_;
  TrafficConfig config_;
  RouteConfig route_;
  Random random_;
  double time_s_ = 0.0;
  double fright_left_s_ = 0.0;
  std::vector<bool> signalled_;                            ///< By junction.
  std::vector<double> signal_offset_s_;                    ///< By junction.
  std::vector<Driver> drivers_;                            ///< The vehicle first.
  std::vector<std::vector<std::size_t>> drivers_in_lane_;  ///< Ascending arc_m.
  std::vector<int> reservations_;                          ///< By lane.
  std::vector<MovingObject> objects_;
};

}  // namespace slammot::simulation
