#include "common/simulation/road_network.hpp"

#include <algorithm>
#include <array>

namespace slammot::simulation {
namespace {

using geometry::Vector2;

constexpr double kBicycleSpeed_mps = 6.0;
constexpr double kLeftTurnSpeed_mps = 6.0;
constexpr double kRightTurnSpeed_mps = 4.8;

double offset_m(const CityConfig& config, RoadUser user) {
  return user == RoadUser::motor ? config.lane_offset_m : config.bicycle_offset_m;
}

/// Point in plan at `ahead_m` from a junction in a direction, `right_m` to the right of that
/// direction.
Vector2 beside(const Vector2& junction_in_plan, Direction direction, double ahead_m,
               double right_m) {
  return junction_in_plan + ahead_m * unit_vector(direction) +
         right_m * unit_vector(turned_left(direction, -1));
}

TurnKind turn_kind(Direction in, Direction out) {
  if (out == in) return TurnKind::straight;
  return out == turned_left(in, 1) ? TurnKind::left : TurnKind::right;
}

double turn_speed_mps(TurnKind kind, double straight_mps) {
  switch (kind) {
    case TurnKind::left: return kLeftTurnSpeed_mps;
    case TurnKind::right: return kRightTurnSpeed_mps;
    case TurnKind::straight: break;
  }
  return straight_mps;
}

/// Below this distance between centre lines two bodies could touch. A long vehicle's ends swing out
/// in a turn.
double conflict_distance_m(const Lane& a, const Lane& b) {
  if (a.user == RoadUser::motor && b.user == RoadUser::motor) return 3.2;
  if (a.user == b.user) return 1.2;
  return a.turn == TurnKind::straight && b.turn == TurnKind::straight ? 1.7 : 2.6;
}

bool come_close(const Path& a, const Path& b, double distance_m) {
  for (const Vector2& point : a.nodes_in_world()) {
    for (const Vector2& other : b.nodes_in_world()) {
      if ((point - other).squaredNorm() < distance_m * distance_m) return true;
    }
  }
  return false;
}

}  // namespace

RoadNetwork::RoadNetwork(const StreetPlan& plan, double speed_limit_mps)
    : speed_limit_mps_(speed_limit_mps) {
  street_lanes_.assign(static_cast<std::size_t>(2 * plan.junction_count() * kDirections), -1);
  for (const RoadUser user : {RoadUser::motor, RoadUser::bicycle}) add_street_lanes(plan, user);
  for (const RoadUser user : {RoadUser::motor, RoadUser::bicycle}) add_turn_lanes(plan, user);
  find_conflicts();
}

int RoadNetwork::street_lane(RoadUser user, int junction, Direction direction) const {
  const int per_user = static_cast<int>(street_lanes_.size()) / 2;
  const int index =
      static_cast<int>(user) * per_user + junction * kDirections + static_cast<int>(direction);
  return street_lanes_[static_cast<std::size_t>(index)];
}

void RoadNetwork::add_street_lanes(const StreetPlan& plan, RoadUser user) {
  const double right_m = offset_m(plan.config(), user);
  const double stop_m = plan.config().stop_line_m;
  const int per_user = static_cast<int>(street_lanes_.size()) / 2;
  for (int from = 0; from < plan.junction_count(); ++from) {
    for (int d = 0; d < kDirections; ++d) {
      const auto direction = static_cast<Direction>(d);
      const auto to = plan.neighbour(plan.junction(from), direction);
      if (!to) continue;
      const Vector2 start =
          beside(plan.junction_in_plan(plan.junction(from)), direction, stop_m, right_m);
      const Vector2 end = beside(plan.junction_in_plan(*to), direction, -stop_m, right_m);
      Lane lane;
      lane.path_in_world = Path(plan.world_from_plan(line(start, end, 0.5)));
      lane.user = user;
      lane.junction = plan.index(*to);
      lane.travel = direction;
      lane.speed_limit_mps = user == RoadUser::motor ? speed_limit_mps_ : kBicycleSpeed_mps;
      street_lanes_[static_cast<std::size_t>(static_cast<int>(user) * per_user +
                                             from * kDirections + d)] =
          static_cast<int>(lanes_.size());
      lanes_.push_back(std::move(lane));
    }
  }
}

void RoadNetwork::add_turn_lanes(const StreetPlan& plan, RoadUser user) {
  const double right_m = offset_m(plan.config(), user);
  const double stop_m = plan.config().stop_line_m;
  const std::size_t existing = lanes_.size();
  for (std::size_t i = 0; i < existing; ++i) {
    if (lanes_[i].kind != LaneKind::street || lanes_[i].user != user) continue;
    const int junction = lanes_[i].junction;
    const Direction in = lanes_[i].travel;
    for (const int quarter : {0, 1, -1}) {
      const Direction out = turned_left(in, quarter);
      const int exit = street_lane(user, junction, out);
      if (exit < 0) continue;
      const Vector2 centre = plan.junction_in_plan(plan.junction(junction));
      const Vector2 start = beside(centre, in, -stop_m, right_m);
      const Vector2 end = beside(centre, out, stop_m, right_m);
      // 0.55 of the way to the corner makes a Bezier curve run close to a quarter circle; straight
      // on it makes a line.
      const double reach_m = 0.55 * (quarter == 0 ? (end - start).norm()
                                                  : std::abs((end - start).dot(unit_vector(in))));
      Lane lane;
      lane.path_in_world = Path(plan.world_from_plan(bezier(
          start, start + reach_m * unit_vector(in), end - reach_m * unit_vector(out), end, 0.25)));
      lane.kind = LaneKind::turn;
      lane.turn = turn_kind(in, out);
      lane.user = user;
      lane.junction = junction;
      lane.travel = in;
      lane.speed_limit_mps =
          turn_speed_mps(lane.turn, user == RoadUser::motor ? speed_limit_mps_ : kBicycleSpeed_mps);
      if (user == RoadUser::bicycle) lane.speed_limit_mps = std::min(lane.speed_limit_mps, 4.5);
      lane.next = {exit};
      lanes_[i].next.push_back(static_cast<int>(lanes_.size()));
      lanes_.push_back(std::move(lane));
    }
    for (const int turn : lanes_[i].next)
      lanes_[static_cast<std::size_t>(turn)].siblings = lanes_[i].next;
  }
}

void RoadNetwork::find_conflicts() {
  for (std::size_t a = 0; a < lanes_.size(); ++a) {
    for (std::size_t b = a + 1; b < lanes_.size(); ++b) {
      if (lanes_[a].kind != LaneKind::turn || lanes_[b].kind != LaneKind::turn) continue;
      if (lanes_[a].junction != lanes_[b].junction) continue;
      const bool follow_each_other =
          lanes_[a].user == lanes_[b].user && lanes_[a].travel == lanes_[b].travel;
      const double distance_m = conflict_distance_m(lanes_[a], lanes_[b]);
      if (follow_each_other ||
          !come_close(lanes_[a].path_in_world, lanes_[b].path_in_world, distance_m))
        continue;
      lanes_[a].conflicts.push_back(static_cast<int>(b));
      lanes_[b].conflicts.push_back(static_cast<int>(a));
    }
  }
}

}  // namespace slammot::simulation
