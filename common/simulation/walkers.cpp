#include "common/simulation/walkers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kPavement_m = 8.15;      ///< From the street's centre line to the middle of the
                                          ///< pavement.
constexpr double kPersonalSpace_m = 0.9;  ///< People stop this far from a vehicle in their way.
constexpr double kPatience_s = 3.0;
constexpr double kSidestep_mps = 0.6;
constexpr double kArrived_m = 0.4;
constexpr double kTurnRate_radps = 2.5;
constexpr double kWalkingAcceleration_mps2 = 1.2;

/// Pavement corners of a junction, counter-clockwise from the north-east.
constexpr int kCorners = 4;
Vector2 corner_in_plan(const Vector2& junction_in_plan, int corner) {
  const double x = corner == 0 || corner == 3 ? kPavement_m : -kPavement_m;
  const double y = corner < 2 ? kPavement_m : -kPavement_m;
  return junction_in_plan + Vector2{x, y};
}

/// Both corners of a junction beside the street that leaves it: on its left and on its right.
struct CornerPair {
  int left, right;
};
CornerPair corners_beside(Direction arm) {
  const int d = static_cast<int>(arm);
  return {d, (d + kCorners - 1) % kCorners};
}

/// Chain of places from one to another, close enough together to follow a bent street.
void connect_along(WalkGraph& graph, const StreetPlan& plan, int from, int to,
                   const Vector2& from_in_plan, const Vector2& to_in_plan) {
  const int pieces = std::max(1, static_cast<int>((to_in_plan - from_in_plan).norm() / 18.0));
  int last = from;
  for (int i = 1; i < pieces; ++i) {
    const Vector2 place =
        from_in_plan + (to_in_plan - from_in_plan) * (static_cast<double>(i) / pieces);
    const int next = graph.add_place(plan.world_from_plan(place));
    graph.connect(last, next);
    last = next;
  }
  graph.connect(last, to);
}

}  // namespace

int WalkGraph::add_place(const Vector2& place_in_world) {
  places_in_world.push_back(place_in_world);
  ways.emplace_back();
  return static_cast<int>(places_in_world.size()) - 1;
}

void WalkGraph::connect(int a, int b, std::optional<Crossing> crossing) {
  ways[static_cast<std::size_t>(a)].push_back({b, crossing});
  ways[static_cast<std::size_t>(b)].push_back({a, crossing});
}

WalkGraph pavements(const StreetPlan& plan) {
  WalkGraph graph;
  for (int junction = 0; junction < plan.junction_count(); ++junction) {
    const Vector2 centre = plan.junction_in_plan(plan.junction(junction));
    for (int corner = 0; corner < kCorners; ++corner) {
      graph.add_place(plan.world_from_plan(corner_in_plan(centre, corner)));
    }
  }
  for (int junction = 0; junction < plan.junction_count(); ++junction) {
    const Vector2 centre = plan.junction_in_plan(plan.junction(junction));
    for (int d = 0; d < kDirections; ++d) {
      const auto arm = static_cast<Direction>(d);
      const CornerPair here = corners_beside(arm);
      graph.connect(junction * kCorners + here.left, junction * kCorners + here.right,
                    Crossing{junction, arm});
      const auto next = plan.neighbour(plan.junction(junction), arm);
      if (!next || d >= 2) continue;  // each street once, from its west or south end
      const CornerPair there = corners_beside(turned_left(arm, 2));
      const Vector2 there_centre = plan.junction_in_plan(*next);
      const int there_first = plan.index(*next) * kCorners;
      connect_along(graph, plan, junction * kCorners + here.left, there_first + there.right,
                    corner_in_plan(centre, here.left), corner_in_plan(there_centre, there.right));
      connect_along(graph, plan, junction * kCorners + here.right, there_first + there.left,
                    corner_in_plan(centre, here.right), corner_in_plan(there_centre, there.left));
    }
  }
  return graph;
}

Walkers::Walkers(WalkGraph graph, const WalkersConfig& config, std::uint64_t seed)
    : graph_(std::move(graph)), config_(config), random_(seed, Purpose::pedestrians) {
  int left = config.pedestrians;
  while (left > 0) {
    const double draw = random_.uniform();
    const int wanted = draw < config.trio_share                       ? 3
                       : draw < config.trio_share + config.pair_share ? 2
                                                                      : 1;
    const int members = std::min(left, wanted);
    groups_.push_back(make_group(members));
    left -= members;
  }
}

Walkers::Group Walkers::make_group(int members) {
  Group group;
  group.walking_speed_mps =
      std::clamp(config_.speed_mps + config_.speed_sigma_mps * random_.normal(), 0.5, 2.0);
  if (members == 1 && random_.chance(config_.runner_share))
    group.walking_speed_mps = random_.uniform(2.5, 3.5);
  group.sideways_in_world = {random_.uniform(-config_.sideways_m, config_.sideways_m),
                             random_.uniform(-config_.sideways_m, config_.sideways_m)};
  for (int i = 0; i < members; ++i) {
    group.members_in_group.push_back(
        {random_.uniform(-0.25, 0.25), 0.6 * (i - 0.5 * (members - 1))});
  }
  group.phase_rad = random_.uniform(0.0, 2.0 * std::numbers::pi);
  group.way.to = static_cast<int>(random_.index(graph_.places_in_world.size()));
  choose_way(group);
  const double fraction = group.way.crossing ? 0.0 : random_.uniform();
  const Vector2 from = graph_.places_in_world[static_cast<std::size_t>(group.from)];
  const Vector2 to = graph_.places_in_world[static_cast<std::size_t>(group.way.to)];
  group.position_in_world = from + fraction * (to - from) + group.sideways_in_world;
  group.heading_rad = std::atan2((to - from).y(), (to - from).x());
  return group;
}

void Walkers::choose_way(Group& group) {
  const int came_from = group.from;
  group.from = group.way.to;
  std::vector<WalkGraph::Way> choices = graph_.ways[static_cast<std::size_t>(group.from)];
  if (choices.size() > 1) {
    std::erase_if(choices, [&](const WalkGraph::Way& way) { return way.to == came_from; });
  }
  group.way = choices[random_.index(choices.size())];
  group.waits_to_cross = group.way.crossing.has_value();
}

void Walkers::advance(double dt_s, const StreetView& street) {
  for (Group& group : groups_) advance(group, dt_s, street);
}

void Walkers::advance(Group& group, double dt_s, const StreetView& street) {
  if (group.waits_to_cross && street.may_start(*group.way.crossing)) group.waits_to_cross = false;
  const bool crosses = group.way.crossing.has_value();
  if (group.pause_left_s <= 0.0 && !crosses && random_.chance(dt_s / config_.pause_every_s)) {
    group.pause_left_s = random_.uniform(0.3, 1.0) * config_.pause_s;
  }
  group.pause_left_s -= dt_s;
  // A pedestrian and a vehicle could wait for each other for ever, so that pedestrians finally
  // pass.
  const bool blocked =
      !group.waits_to_cross && vehicle_ahead(group, street) && group.blocked_s < kPatience_s;
  group.blocked_s = blocked ? group.blocked_s + dt_s : std::max(0.0, group.blocked_s - 0.2 * dt_s);
  if (blocked && !crosses) step_aside(group, dt_s);
  const bool stands = group.waits_to_cross || group.pause_left_s > 0.0 || blocked;

  const Vector2 target =
      graph_.places_in_world[static_cast<std::size_t>(group.way.to)] + group.sideways_in_world;
  const Vector2 ahead = target - group.position_in_world;
  const double wanted_turn_rad =
      geometry::wrap_angle(std::atan2(ahead.y(), ahead.x()) - group.heading_rad);
  const double turn_rad =
      std::clamp(wanted_turn_rad, -kTurnRate_radps * dt_s, kTurnRate_radps * dt_s);
  if (!stands) group.heading_rad = geometry::wrap_angle(group.heading_rad + turn_rad);

  // Pedestrians slow down while they turn, so that they do not circle around their goal.
  const double facing = std::max(0.1, std::cos(wanted_turn_rad));
  const double wanted_mps = stands ? 0.0 : group.walking_speed_mps * facing;
  const double change_mps = kWalkingAcceleration_mps2 * dt_s;
  group.speed_mps += std::clamp(wanted_mps - group.speed_mps, -2.0 * change_mps, change_mps);
  const double step_m = group.speed_mps * dt_s;
  group.position_in_world +=
      step_m * Vector2{std::cos(group.heading_rad), std::sin(group.heading_rad)};
  group.phase_rad += 2.0 * std::numbers::pi * step_m / kPedestrianStride_m;
  if (ahead.norm() < kArrived_m) choose_way(group);
}

void Walkers::step_aside(Group& group, double dt_s) const {
  const Vector2 right{std::sin(group.heading_rad), -std::cos(group.heading_rad)};
  const Vector2 moved = group.sideways_in_world + kSidestep_mps * dt_s * right;
  if (moved.norm() > config_.step_aside_m) return;
  group.position_in_world += moved - group.sideways_in_world;
  group.sideways_in_world = moved;
}

bool Walkers::vehicle_ahead(const Group& group, const StreetView& street) {
  const Pose2 world_from_group{group.position_in_world.x(), group.position_in_world.y(),
                               group.heading_rad};
  return std::any_of(group.members_in_group.begin(), group.members_in_group.end(),
                     [&](const Vector2& member) {
                       return street.is_occupied(world_from_group *
                                                 Vector2(member + Vector2{kPersonalSpace_m, 0.0}));
                     });
}

std::vector<MovingObject> Walkers::objects(int first_id) const {
  std::vector<MovingObject> objects;
  for (const Group& group : groups_) {
    const Pose2 world_from_group{group.position_in_world.x(), group.position_in_world.y(),
                                 group.heading_rad};
    for (std::size_t i = 0; i < group.members_in_group.size(); ++i) {
      MovingObject person;
      person.id = first_id + static_cast<int>(objects.size());
      person.kind = ObjectClass::pedestrian;
      person.size = {0.35, 0.5};
      const Vector2 place = world_from_group * group.members_in_group[i];
      person.world_from_object = {place.x(), place.y(), group.heading_rad};
      person.speed_mps = group.speed_mps;
      const double step_m = kPedestrianStep_m * std::min(1.5, group.speed_mps / config_.speed_mps);
      person.outline_in_object =
          pedestrian_outline(group.phase_rad + 2.0 * static_cast<double>(i), step_m);
      objects.push_back(std::move(person));
    }
  }
  return objects;
}

std::vector<PersonOnRoad> Walkers::on_road() const {
  std::vector<PersonOnRoad> people;
  for (const Group& group : groups_) {
    if (!group.way.crossing || group.waits_to_cross) continue;
    const Pose2 world_from_group{group.position_in_world.x(), group.position_in_world.y(),
                                 group.heading_rad};
    const Vector2 velocity =
        group.speed_mps * Vector2{std::cos(group.heading_rad), std::sin(group.heading_rad)};
    for (const Vector2& member : group.members_in_group)
      people.push_back({world_from_group * member, velocity});
  }
  return people;
}

}  // namespace slammot::simulation
