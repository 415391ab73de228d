#include "common/simulation/traffic.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

// Treiber, Hennecke, Helbing 2000, Table I, with a livelier acceleration for a city.
constexpr double kAcceleration_mps2 = 1.8;
constexpr double kComfortableBraking_mps2 = 2.2;
constexpr double kHardestBraking_mps2 = 8.0;
constexpr double kHeadway_s = 1.3;
constexpr double kStandstillGap_m = 2.0;

constexpr double kSight_m = 60.0;
constexpr double kFar_m = 1e6;
constexpr std::size_t kPlannedLanes = 4;
constexpr double kWaysPart_m = 8.5;  ///< Past the stop line a left turn is a car's width away from
                                     ///< straight on.

/// Of the vehicles sold: small cars to estates, vans, trucks without and with trailer, midibuses to
/// articulated buses (drawn as one rigid body).
BoxSize varied_size_of(ObjectClass kind, Random& random) {
  constexpr double kShareOfVans = 0.15;
  constexpr double kShareWithTrailer = 0.4;
  switch (kind) {
    case ObjectClass::car:
      if (random.chance(kShareOfVans)) return {random.uniform(5.0, 6.0), random.uniform(1.9, 2.1)};
      return {random.uniform(3.4, 5.3), random.uniform(1.6, 1.95)};
    case ObjectClass::truck:
      return {
          random.chance(kShareWithTrailer) ? random.uniform(12.0, 16.5) : random.uniform(6.0, 10.0),
          random.uniform(2.3, 2.55)};
    case ObjectClass::bus: return {random.uniform(8.0, 18.0), 2.55};
    case ObjectClass::bicycle:
    case ObjectClass::pedestrian: break;
  }
  return usual_size(kind);
}

BoxSize size_of(ObjectClass kind, Random& random) {
  if (kind != ObjectClass::car) return usual_size(kind);
  return {random.uniform(4.0, 4.8), random.uniform(1.7, 1.9)};
}

Direction direction_between(const JunctionId& from, const JunctionId& to) {
  if (to.column != from.column) return to.column > from.column ? Direction::east : Direction::west;
  return to.row > from.row ? Direction::north : Direction::south;
}

}  // namespace

Traffic::Traffic(const StreetPlan& plan, const Setup& setup)
    : plan_(plan),
      network_(plan),
      config_(setup.traffic),
      route_(setup.route),
      random_(setup.seed, Purpose::traffic) {
  const double cycle_s = 2.0 * (config_.green_s + config_.clearance_s);
  for (int i = 0; i < plan_.junction_count(); ++i) {
    signalled_.push_back(random_.chance(plan_.config().signalled_share));
    signal_offset_s_.push_back(random_.uniform(0.0, cycle_s));
  }
  reservations_.assign(network_.lanes().size(), 0);
  drivers_in_lane_.resize(network_.lanes().size());
  place_vehicle(setup.route);
  place_drivers(setup.traffic);
  publish();
}

void Traffic::place_vehicle(const RouteConfig& route) {
  Driver vehicle;
  vehicle.length_m = route.length_m;
  vehicle.half_width_m = 0.5 * route.width_m;
  vehicle.speed_factor = route.speed_factor;
  place_on_route(vehicle, along_streets(route.junctions), route.start_m);
}

void Traffic::place_on_route(Driver& driver, const std::vector<JunctionId>& route, double arc_m) {
  const bool free = route.size() < 2;
  const JunctionId from = free ? JunctionId{0, 0} : route[0];
  const Direction direction = free ? Direction::east : direction_between(from, route[1]);
  driver.lanes = {network_.street_lane(RoadUser::motor, plan_.index(from), direction)};
  driver.arc_m = arc_m;
  if (!free) driver.route.assign(route.begin() + 1, route.end());
  drivers_.push_back(std::move(driver));
  extend_plan(drivers_.back());
}

void Traffic::place_drivers(const TrafficConfig& config) {
  if (!config.car_ahead.empty()) place_car_ahead(along_streets(config.car_ahead));
  const auto place = [&](ObjectClass kind, int count) {
    for (int i = 0; i < count; ++i) {
      Driver driver = make_driver(kind, config);
      if (!place_at_random(driver)) return;  // no free place
      drivers_.push_back(std::move(driver));
      extend_plan(drivers_.back());
    }
  };
  place(ObjectClass::bus, config.buses);
  place(ObjectClass::truck, config.trucks);
  place(ObjectClass::car, config.cars);
  place(ObjectClass::bicycle, config.bicycles);
}

void Traffic::place_car_ahead(const std::vector<JunctionId>& route) {
  Driver car;
  car.speed_factor = 0.9;
  car.stop_every_m = 60.0;
  car.next_stop_m = 20.0;
  place_on_route(car, route, route_.start_m + 12.0);
}

Traffic::Driver Traffic::make_driver(ObjectClass kind, const TrafficConfig& config) {
  Driver driver;
  driver.kind = kind;
  driver.user = kind == ObjectClass::bicycle ? RoadUser::bicycle : RoadUser::motor;
  const BoxSize size = config.varied_sizes ? varied_size_of(kind, random_) : size_of(kind, random_);
  driver.length_m = size.length_m;
  driver.half_width_m = 0.5 * size.width_m;
  const double spread_m = kind == ObjectClass::car ? 0.12 : 0.03;
  driver.sideways_m = std::clamp(spread_m * random_.normal(), -2.0 * spread_m, 2.0 * spread_m);
  driver.speed_factor = std::clamp(1.0 + 0.12 * random_.normal(), 0.7, 1.25);
  if (kind == ObjectClass::bus) driver.speed_factor = 0.85;
  const bool stops = kind == ObjectClass::bus ||
                     (driver.user == RoadUser::motor && random_.chance(config.stopping_share));
  if (stops) driver.stop_every_m = kind == ObjectClass::bus ? 180.0 : 120.0;
  driver.next_stop_m = driver.stop_every_m * random_.uniform(0.3, 1.2);
  return driver;
}

bool Traffic::place_at_random(Driver& driver) {
  for (int attempt = 0; attempt < 200; ++attempt) {
    const std::size_t lane = random_.index(network_.lanes().size());
    const Lane& candidate = network_.lanes()[lane];
    if (candidate.kind != LaneKind::street || candidate.user != driver.user) continue;
    const double clear_m = 0.5 * driver.length_m + 1.0;
    driver.arc_m = random_.uniform(clear_m, candidate.path_in_world.length_m() - clear_m);
    const bool free = std::none_of(drivers_.begin(), drivers_.end(), [&](const Driver& other) {
      const double apart_m = 0.5 * (other.length_m + driver.length_m) + 4.0;
      return other.lanes.front() == static_cast<int>(lane) &&
             std::abs(other.arc_m - driver.arc_m) < apart_m;
    });
    if (!free) continue;
    driver.lanes = {static_cast<int>(lane)};
    return true;
  }
  return false;
}

void Traffic::extend_plan(Driver& driver) {
  while (driver.lanes.size() < kPlannedLanes) {
    const int last = driver.lanes.back();
    const bool street = network_.lane(last).kind == LaneKind::street;
    driver.lanes.push_back(street ? choose_turn(driver, last) : network_.lane(last).next.front());
  }
}

int Traffic::choose_turn(Driver& driver, int street_lane) {
  std::vector<int> turns = network_.lane(street_lane).next;
  if (!driver.route.empty()) driver.route.erase(driver.route.begin());
  if (!driver.route.empty()) {
    const JunctionId here = plan_.junction(network_.lane(street_lane).junction);
    const Direction wanted = direction_between(here, driver.route.front());
    for (const int turn : turns) {
      if (network_.lane(network_.lane(turn).next.front()).travel == wanted) return turn;
    }
  }
  // Buses cannot turn right without leaving their lane, and bicycles avoid left turns.
  const auto avoid = [&](TurnKind kind) {
    const auto unwanted = [&](int turn) { return network_.lane(turn).turn == kind; };
    if (!std::all_of(turns.begin(), turns.end(), unwanted)) std::erase_if(turns, unwanted);
  };
  if (driver.kind == ObjectClass::bus) avoid(TurnKind::right);
  if (driver.kind == ObjectClass::bicycle) avoid(TurnKind::left);
  return turns[random_.index(turns.size())];
}

void Traffic::sort_into_lanes() {
  for (auto& lane : drivers_in_lane_) lane.clear();
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    drivers_in_lane_[static_cast<std::size_t>(drivers_[i].lanes.front())].push_back(i);
  }
  for (auto& lane : drivers_in_lane_) {
    std::stable_sort(lane.begin(), lane.end(), [this](std::size_t a, std::size_t b) {
      return drivers_[a].arc_m < drivers_[b].arc_m;
    });
  }
}

void Traffic::advance(double dt_s, const std::vector<PersonOnRoad>& people) {
  time_s_ += dt_s;
  sort_into_lanes();
  std::vector<double> accelerations_mps2;
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    Driver& driver = drivers_[i];
    ask_for_turn(driver);
    const double free_mps2 = acceleration_mps2(driver, people);
    const double limit = limit_mps(driver, driver.lanes.front());
    const double behind_mps2 =
        std::min(follow_mps2(driver, limit, leader(i)), follow_mps2(driver, limit, turning_off(i)));
    accelerations_mps2.push_back(
        std::clamp(std::min(free_mps2, behind_mps2), -kHardestBraking_mps2, kAcceleration_mps2));
  }
  if (frightened(dt_s))
    accelerations_mps2.front() = std::min(accelerations_mps2.front(), -route_.hard_brake_mps2);
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    move(drivers_[i], accelerations_mps2[i], dt_s);
    if (drivers_[i].stop_left_s > 0.0 && drivers_[i].speed_mps < 0.05)
      drivers_[i].stop_left_s -= dt_s;
  }
  publish();
}

double Traffic::limit_mps(const Driver& driver, int lane) const {
  return driver.speed_factor * network_.lane(lane).speed_limit_mps;
}

double Traffic::follow_mps2(const Driver& driver, double limit, const Obstacle& obstacle) const {
  const double free = std::pow(driver.speed_mps / limit, 4);
  if (obstacle.gap_m > kSight_m) return kAcceleration_mps2 * (1.0 - free);
  const double gap_m = std::max(0.1, obstacle.gap_m);
  const double closing_mps = driver.speed_mps - obstacle.speed_mps;
  const double wanted_m =
      kStandstillGap_m +
      std::max(0.0, driver.speed_mps * kHeadway_s +
                        driver.speed_mps * closing_mps /
                            (2.0 * std::sqrt(kAcceleration_mps2 * kComfortableBraking_mps2)));
  return kAcceleration_mps2 * (1.0 - free - (wanted_m / gap_m) * (wanted_m / gap_m));
}

double Traffic::acceleration_mps2(Driver& driver, const std::vector<PersonOnRoad>& people) {
  const Lane& here = network_.lane(driver.lanes.front());
  const double limit = limit_mps(driver, driver.lanes.front());
  double acceleration = bend_braking_mps2(driver);
  const auto stop_at = [&](double gap_m) {
    // The gap kept to a line is one metre less than to a bumper.
    acceleration = std::min(acceleration, follow_mps2(driver, limit, {gap_m + 1.0, 0.0}));
  };
  if (here.kind == LaneKind::street && driver.reserved_turn != driver.lanes[1]) {
    stop_at(here.path_in_world.length_m() - driver.arc_m - 0.5 * driver.length_m);
  }
  stop_at(person_gap_m(driver, people));
  stop_at(own_stop_gap_m(driver));
  return acceleration;
}

double Traffic::bend_braking_mps2(const Driver& driver) const {
  double acceleration = kAcceleration_mps2;
  double ahead_m = network_.lane(driver.lanes.front()).path_in_world.length_m() - driver.arc_m;
  for (std::size_t i = 1; i < driver.lanes.size() && ahead_m < kSight_m; ++i) {
    const double limit = limit_mps(driver, driver.lanes[i]);
    if (driver.speed_mps > limit) {
      const double needed =
          (driver.speed_mps * driver.speed_mps - limit * limit) / (2.0 * std::max(0.5, ahead_m));
      if (needed > 0.7 * kComfortableBraking_mps2) acceleration = std::min(acceleration, -needed);
    }
    ahead_m += network_.lane(driver.lanes[i]).path_in_world.length_m();
  }
  return acceleration;
}

Traffic::Obstacle Traffic::leader(std::size_t index) const {
  const Driver& driver = drivers_[index];
  double lane_start_m = -driver.arc_m;  // of the current lane, ahead of this driver's centre
  for (std::size_t i = 0; i < driver.lanes.size() && lane_start_m < kSight_m; ++i) {
    const Lane& lane = network_.lane(driver.lanes[i]);
    for (const std::size_t other : drivers_in_lane_[static_cast<std::size_t>(driver.lanes[i])]) {
      const double ahead_m = lane_start_m + drivers_[other].arc_m;
      const bool behind = i == 0 && (ahead_m < 0.0 || (ahead_m == 0.0 && other <= index));
      if (behind || other == index) continue;
      return {ahead_m - 0.5 * (driver.length_m + drivers_[other].length_m),
              drivers_[other].speed_mps};
    }
    lane_start_m += lane.path_in_world.length_m();
  }
  return {kFar_m, 0.0};
}

Traffic::Obstacle Traffic::turning_off(std::size_t index) const {
  const Driver& driver = drivers_[index];
  const Lane& here = network_.lane(driver.lanes.front());
  const bool on_street = here.kind == LaneKind::street;
  const int own_turn = on_street ? driver.lanes[1] : driver.lanes.front();
  const double line_ahead_m = (on_street ? here.path_in_world.length_m() : 0.0) - driver.arc_m;
  Obstacle nearest{kFar_m, 0.0};
  for (const int turn : network_.lane(own_turn).siblings) {
    if (turn == own_turn) continue;
    for (const std::size_t other : drivers_in_lane_[static_cast<std::size_t>(turn)]) {
      const Driver& turning = drivers_[other];
      const double ahead_m = line_ahead_m + turning.arc_m;
      const bool apart = turning.arc_m - 0.5 * turning.length_m > kWaysPart_m;
      if (apart || ahead_m < 0.0 || (ahead_m == 0.0 && other < index)) continue;
      const double gap_m = ahead_m - 0.5 * (driver.length_m + turning.length_m);
      if (gap_m < nearest.gap_m) nearest = {gap_m, turning.speed_mps};
    }
  }
  return nearest;
}

void Traffic::ask_for_turn(Driver& driver) {
  const Lane& here = network_.lane(driver.lanes.front());
  if (here.kind != LaneKind::street || driver.reserved_turn >= 0 || driver.stop_left_s > 0.0)
    return;
  const double to_line_m = here.path_in_world.length_m() - driver.arc_m - 0.5 * driver.length_m;
  const double braking_m = driver.speed_mps * driver.speed_mps / (2.0 * kComfortableBraking_mps2);
  if (to_line_m > braking_m + 10.0 || !is_next_to_go(driver) ||
      !turn_is_free(driver, driver.lanes[1]))
    return;
  driver.reserved_turn = driver.lanes[1];
  ++reservations_[static_cast<std::size_t>(driver.reserved_turn)];
}

bool Traffic::is_next_to_go(const Driver& driver) const {
  // A driver behind a waiting one must not reserve the turn that it waits for: that would be a
  // deadlock.
  const auto& lane = drivers_in_lane_[static_cast<std::size_t>(driver.lanes.front())];
  return std::none_of(lane.begin(), lane.end(), [&](std::size_t other) {
    return drivers_[other].arc_m > driver.arc_m &&
           drivers_[other].reserved_turn != drivers_[other].lanes[1];
  });
}

bool Traffic::turn_is_free(const Driver& driver, int turn) const {
  const Lane& lane = network_.lane(turn);
  if (!has_green(lane.junction, lane.travel)) return false;
  for (const int conflict : lane.conflicts) {
    if (reservations_[static_cast<std::size_t>(conflict)] > 0) return false;
  }
  // Space behind the junction: no vehicle stops inside it.
  const int exit = lane.next.front();
  double room_m = kFar_m;
  for (const std::size_t other : drivers_in_lane_[static_cast<std::size_t>(exit)]) {
    const Driver& last = drivers_[other];
    if (last.speed_mps < 4.0) room_m = last.arc_m - 0.5 * last.length_m;
    break;
  }
  double needed_m = driver.length_m + 3.0;
  for (const Driver& other : drivers_) {
    const bool will_be_there = other.reserved_turn >= 0 &&
                               network_.lane(other.reserved_turn).next.front() == exit &&
                               other.lanes.front() != exit;
    if (will_be_there) needed_m += other.length_m + 3.0;
  }
  return needed_m < room_m;
}

bool Traffic::has_green(int junction, Direction travel) const {
  const auto i = static_cast<std::size_t>(junction);
  if (!signalled_[i]) return true;
  const double half_s = config_.green_s + config_.clearance_s;
  const double phase_s = std::fmod(time_s_ + signal_offset_s_[i], 2.0 * half_s);
  const bool east_west = travel == Direction::east || travel == Direction::west;
  return east_west ? phase_s < config_.green_s
                   : phase_s >= half_s && phase_s < half_s + config_.green_s;
}

bool Traffic::may_cross(const Crossing& crossing) const {
  const auto i = static_cast<std::size_t>(crossing.junction);
  if (signalled_[i]) {
    // Pedestrians cross with the traffic that does not use this arm, and start only early in its
    // green phase.
    const Direction across = turned_left(crossing.arm, 1);
    const double half_s = config_.green_s + config_.clearance_s;
    const double phase_s = std::fmod(time_s_ + signal_offset_s_[i], half_s);
    return has_green(crossing.junction, across) && phase_s < 0.4 * config_.green_s;
  }
  const Vector2 middle = plan_.world_from_plan(Vector2(
      plan_.junction_in_plan(plan_.junction(crossing.junction)) + 8.0 * unit_vector(crossing.arm)));
  return std::none_of(drivers_.begin(), drivers_.end(), [&](const Driver& driver) {
    const Pose2 pose = pose_ahead(driver, 0.0);
    const Vector2 to_crossing = middle - pose.translation_m();
    const bool towards =
        to_crossing.dot(Vector2{std::cos(pose.heading_rad), std::sin(pose.heading_rad)}) >
        -0.5 * driver.length_m;
    return towards && to_crossing.norm() < 9.0 + 5.0 * driver.speed_mps;
  });
}

bool Traffic::is_occupied(const Vector2& place_in_world) const {
  return std::any_of(objects_.begin(), objects_.end(), [&](const MovingObject& object) {
    const double reach_m = object.size.length_m + object.size.width_m;
    if ((place_in_world - object.world_from_object.translation_m()).squaredNorm() >
        reach_m * reach_m)
      return false;
    const Vector2 in_object = inverse(object.world_from_object) * place_in_world;
    return std::abs(in_object.x()) < 0.5 * object.size.length_m &&
           std::abs(in_object.y()) < 0.5 * object.size.width_m;
  });
}

StreetView Traffic::street_view() const {
  return {[this](const Crossing& crossing) { return may_cross(crossing); },
          [this](const Vector2& place_in_world) { return is_occupied(place_in_world); }};
}

double Traffic::person_gap_m(const Driver& driver, const std::vector<PersonOnRoad>& people) const {
  constexpr double kClearance_m = 0.7;
  const double braking_m = driver.speed_mps * driver.speed_mps / (2.0 * kComfortableBraking_mps2);
  const double look_m = 0.5 * driver.length_m + braking_m + 6.0;
  const Pose2 now = pose_ahead(driver, 0.0);
  double nearest_m = kFar_m;
  for (const PersonOnRoad& person : people) {
    if ((person.position_in_world - now.translation_m()).norm() > look_m + 6.0) continue;
    // No vehicle starts while a pedestrian passes close by.
    const Vector2 beside = inverse(now) * person.position_in_world;
    const bool touches = std::abs(beside.x()) < 0.5 * driver.length_m + 0.4 &&
                         std::abs(beside.y()) < driver.half_width_m + 0.3;
    if (touches && driver.speed_mps < 1.0) return 0.0;
    for (double ahead_m = 0.5 * driver.length_m; ahead_m < std::min(look_m, nearest_m);
         ahead_m += 1.0) {
      const Pose2 world_from_place = pose_ahead(driver, ahead_m);
      const double far_m =
          driver.half_width_m + kClearance_m + 0.8 + 3.0 * person.velocity_in_world_mps.norm();
      if ((person.position_in_world - world_from_place.translation_m()).squaredNorm() >
          far_m * far_m)
        continue;
      const Vector2 in_place = inverse(world_from_place) * person.position_in_world;
      if (std::abs(in_place.x()) > 0.8) continue;
      const Vector2 velocity =
          geometry::rotation(-world_from_place.heading_rad) * person.velocity_in_world_mps;
      const bool comes = in_place.y() * velocity.y() < 0.0;
      const double reach_m =
          driver.half_width_m + kClearance_m + (comes ? 3.0 * std::abs(velocity.y()) : 0.0);
      if (std::abs(in_place.y()) < reach_m) nearest_m = ahead_m;
    }
  }
  return nearest_m >= kFar_m ? kFar_m : nearest_m - 0.5 * driver.length_m - 1.5;
}

double Traffic::own_stop_gap_m(Driver& driver) {
  if (driver.stop_every_m <= 0.0) return kFar_m;
  const Lane& here = network_.lane(driver.lanes.front());
  const double to_line_m = here.path_in_world.length_m() - driver.arc_m;
  const bool middle_of_street =
      here.kind == LaneKind::street && driver.arc_m > 12.0 && to_line_m > 25.0;
  const bool due = driver.stop_left_s <= 0.0 && driver.travelled_m > driver.next_stop_m;
  if (due && middle_of_street && driver.reserved_turn < 0) {
    driver.stop_left_s = random_.uniform(3.0, driver.kind == ObjectClass::bus ? 14.0 : 8.0);
    driver.next_stop_m = driver.travelled_m + driver.stop_every_m * random_.uniform(0.6, 1.4);
  }
  if (driver.stop_left_s <= 0.0) return kFar_m;
  // A stop uses a comfortable deceleration from its beginning, wherever it ends.
  const double braking_m = driver.speed_mps * driver.speed_mps / (2.0 * kComfortableBraking_mps2);
  return driver.speed_mps < 0.5 ? 0.0 : braking_m + 1.0;
}

bool Traffic::frightened(double dt_s) {
  fright_left_s_ -= dt_s;
  const bool may_start =
      fright_left_s_ <= 0.0 && route_.hard_brake_every_s > 0.0 && drivers_.front().speed_mps > 5.0;
  if (may_start && random_.chance(dt_s / route_.hard_brake_every_s))
    fright_left_s_ = random_.uniform(0.5, 1.3);
  return fright_left_s_ > 0.0;
}

void Traffic::move(Driver& driver, double acceleration, double dt_s) {
  const double new_speed_mps = std::max(0.0, driver.speed_mps + acceleration * dt_s);
  const double step_m = 0.5 * (driver.speed_mps + new_speed_mps) * dt_s;
  driver.speed_mps = new_speed_mps;
  driver.arc_m += step_m;
  driver.travelled_m += step_m;
  const Lane& lane = network_.lane(driver.lanes.front());
  if (driver.arc_m >= lane.path_in_world.length_m()) {
    driver.arc_m -= lane.path_in_world.length_m();
    driver.last_lane = driver.lanes.front();
    driver.lanes.erase(driver.lanes.begin());
    extend_plan(driver);
  }
  const bool left_junction =
      driver.reserved_turn >= 0 && driver.lanes.front() != driver.reserved_turn &&
      driver.lanes[1] != driver.reserved_turn && driver.arc_m > 0.5 * driver.length_m;
  if (left_junction) {
    --reservations_[static_cast<std::size_t>(driver.reserved_turn)];
    driver.reserved_turn = -1;
  }
}

Pose2 Traffic::pose_ahead(const Driver& driver, double ahead_m) const {
  double arc_m = driver.arc_m + ahead_m;
  if (arc_m < 0.0 && driver.last_lane >= 0) {
    const Path& last = network_.lane(driver.last_lane).path_in_world;
    return last.pose_at(last.length_m() + arc_m) * Pose2{0.0, driver.sideways_m, 0.0};
  }
  std::size_t i = 0;
  while (i + 1 < driver.lanes.size() &&
         arc_m > network_.lane(driver.lanes[i]).path_in_world.length_m()) {
    arc_m -= network_.lane(driver.lanes[i]).path_in_world.length_m();
    ++i;
  }
  return network_.lane(driver.lanes[i]).path_in_world.pose_at(arc_m) *
         Pose2{0.0, driver.sideways_m, 0.0};
}

Pose2 Traffic::pose_on_axles(const Driver& driver) const {
  const double to_axle_m = 0.42 * driver.length_m;
  const Vector2 front = pose_ahead(driver, to_axle_m).translation_m();
  const Vector2 rear = pose_ahead(driver, -to_axle_m).translation_m();
  const Vector2 middle = 0.5 * (front + rear);
  return {middle.x(), middle.y(), std::atan2((front - rear).y(), (front - rear).x())};
}

void Traffic::publish() {
  if (objects_.empty()) {
    for (const Driver& driver : drivers_) {
      MovingObject object;
      object.id = static_cast<int>(objects_.size());
      object.kind = driver.kind;
      object.size = {driver.length_m, 2.0 * driver.half_width_m};
      object.outline_in_object = vehicle_outline(driver.kind, object.size);
      objects_.push_back(std::move(object));
    }
  }
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    // Odometry's reference point moves straight ahead, so that it stays on the way.
    objects_[i].world_from_object =
        i == 0 ? pose_ahead(drivers_[i], 0.0) : pose_on_axles(drivers_[i]);
    objects_[i].speed_mps = drivers_[i].speed_mps;
  }
}

}  // namespace slammot::simulation
