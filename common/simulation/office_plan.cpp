#include "common/simulation/office_plan.hpp"

#include <algorithm>
#include <cmath>

#include "common/simulation/random.hpp"

namespace slammot::simulation {
namespace {

using geometry::Vector2;

constexpr double kCell_m = 0.05;
constexpr double kMargin_m = 9.0;  ///< Around the ring's middle line: corridor, rooms, outer wall.
constexpr double kWall_m = 0.15;
constexpr double kDoor_m = 0.9;
constexpr double kRecess_m = 0.05;  ///< A closed door lies this far behind the wall's face.

struct Area {
  Vector2 low;
  Vector2 high;
};

Area rectangle(const Vector2& a, const Vector2& b) { return {a.cwiseMin(b), a.cwiseMax(b)}; }

/// Free and solid parts of the floor. All edges lie on multiples of a cell, so walls come out as
/// whole segments.
class Floor {
 public:
  Floor(const Vector2& low, const Vector2& high)
      : low_(low),
        columns_(static_cast<int>(std::ceil((high.x() - low.x()) / kCell_m))),
        rows_(static_cast<int>(std::ceil((high.y() - low.y()) / kCell_m))),
        free_(static_cast<std::size_t>(columns_ * rows_), false) {}

  void set(const Area& part, bool free) {
    for_cells(part, [&](std::size_t cell) { free_[cell] = free; });
  }

  bool is_solid(const Area& part) const {
    bool solid = true;
    for_cells(part, [&](std::size_t cell) { solid = solid && !free_[cell]; });
    return solid && inside(part);
  }

  /// Faces between free and solid, each straight face one segment.
  Outline faces() const {
    Outline outline;
    for (int row = 1; row < rows_; ++row) {
      add_faces(
          outline, columns_,
          [&](int column) { return is_free(column, row) != is_free(column, row - 1); },
          [&](int column) { return at(column, row); });
    }
    for (int column = 1; column < columns_; ++column) {
      add_faces(
          outline, rows_, [&](int row) { return is_free(column, row) != is_free(column - 1, row); },
          [&](int row) { return at(column, row); });
    }
    return outline;
  }

 private:
  template <typename IsFace, typename At>
  static void add_faces(Outline& outline, int count, IsFace is_face, At at) {
    int start = -1;
    for (int i = 0; i <= count; ++i) {
      const bool face = i < count && is_face(i);
      if (face && start < 0) start = i;
      if (face || start < 0) continue;
      outline.segments.push_back({at(start), at(i), Material::wall});
      start = -1;
    }
  }

  template <typename Visit>
  void for_cells(const Area& part, Visit visit) const {
    const auto index = [](double metres) {
      return static_cast<int>(std::lround(metres / kCell_m));
    };
    const int first_column = std::max(0, index(part.low.x() - low_.x()));
    const int last_column = std::min(columns_, index(part.high.x() - low_.x()));
    const int first_row = std::max(0, index(part.low.y() - low_.y()));
    const int last_row = std::min(rows_, index(part.high.y() - low_.y()));
    for (int row = first_row; row < last_row; ++row) {
      for (int column = first_column; column < last_column; ++column)
        visit(static_cast<std::size_t>(row * columns_ + column));
    }
  }

  bool inside(const Area& part) const {
    return part.low.x() >= low_.x() && part.low.y() >= low_.y() &&
           part.high.x() <= at(columns_, rows_).x() && part.high.y() <= at(columns_, rows_).y();
  }
  bool is_free(int column, int row) const {
    return free_[static_cast<std::size_t>(row * columns_ + column)];
  }
  Vector2 at(int column, int row) const { return low_ + kCell_m * Vector2{column, row}; }

  Vector2 low_;
  int columns_;
  int rows_;
  std::vector<bool> free_;
};

/// Middle line of a corridor.
struct Corridor {
  Vector2 from;
  Vector2 to;
};

class OfficeBuilder {
 public:
  OfficeBuilder(const OfficeConfig& config, std::uint64_t seed)
      : config_(config),
        random_(seed, Purpose::world),
        floor_({-kMargin_m, -kMargin_m},
               {config.length_m + kMargin_m, config.depth_m + kMargin_m}) {}

  OfficePlan build() {
    plan_.depth_m = config_.depth_m;
    place_corridors();
    for (const Corridor& corridor : corridors_) floor_.set(corridor_area(corridor), true);
    for (const Corridor& corridor : corridors_) {
      add_rooms(corridor, 1.0);
      add_rooms(corridor, -1.0);
    }
    for (const Corridor& corridor : corridors_) furnish_corridor(corridor);
    plan_.outline_in_world = floor_.faces();
    connect_corridors();
    return std::move(plan_);
  }

 private:
  void place_corridors() {
    plan_.columns_m = {0.0};
    for (int i = 1; i <= config_.cross_corridors; ++i) {
      const double even_m = config_.length_m * i / (config_.cross_corridors + 1);
      plan_.columns_m.push_back(even_m + random_.uniform(-0.12, 0.12) * config_.length_m);
    }
    plan_.columns_m.push_back(config_.length_m);
    corridors_ = {{{0.0, 0.0}, {config_.length_m, 0.0}},
                  {{0.0, config_.depth_m}, {config_.length_m, config_.depth_m}}};
    for (const double x_m : plan_.columns_m)
      corridors_.push_back({{x_m, 0.0}, {x_m, config_.depth_m}});
  }

  Area corridor_area(const Corridor& corridor) const {
    const double half_m = 0.5 * config_.corridor_m;
    return {corridor.from - Vector2{half_m, half_m}, corridor.to + Vector2{half_m, half_m}};
  }

  void add_rooms(const Corridor& corridor, double side) {
    const Vector2 along = (corridor.to - corridor.from).normalized();
    const Vector2 outward = side * Vector2{-along.y(), along.x()};
    const double length_m = (corridor.to - corridor.from).norm();
    double u_m = -4.0;
    while (u_m < length_m + 2.0) {
      const double width_m = std::round(random_.uniform(2.8, 6.0) / kCell_m) * kCell_m;
      const bool added = add_room(corridor.from + u_m * along, along, outward, width_m);
      u_m += added ? width_m + kWall_m : 0.5;
    }
  }

  bool add_room(const Vector2& start_in_world, const Vector2& along, const Vector2& outward,
                double width_m) {
    const double face_m = 0.5 * config_.corridor_m;
    for (double depth_m = 5.5; depth_m > 2.4; depth_m -= 0.5) {
      const Vector2 near = start_in_world + (face_m + kWall_m) * outward;
      const Area room = rectangle(near, near + width_m * along + depth_m * outward);
      const Vector2 wall{kWall_m, kWall_m};
      if (!floor_.is_solid({room.low - wall, room.high + wall})) continue;
      if (!add_door(start_in_world + random_.uniform(0.4, width_m - 1.4) * along, along, outward))
        return false;
      floor_.set(room, true);
      furnish_room(room);
      return true;
    }
    return false;
  }

  /// False where the room would touch no corridor.
  bool add_door(const Vector2& start_in_world, const Vector2& along, const Vector2& outward) {
    const double face_m = 0.5 * config_.corridor_m;
    const Vector2 inside_corridor = start_in_world + (face_m - 0.1) * outward;
    if (floor_.is_solid(
            rectangle(inside_corridor, inside_corridor + kDoor_m * along + kCell_m * outward)))
      return false;
    const Vector2 corner = start_in_world + face_m * outward;
    const double opening_m = random_.chance(config_.open_door_share) ? kWall_m : kRecess_m;
    floor_.set(rectangle(corner, corner + kDoor_m * along + opening_m * outward), true);
    return true;
  }

  /// Desks and cupboards along the walls, a table leg or two in the middle.
  void furnish_room(const Area& room) {
    const Vector2 size = room.high - room.low;
    for (double x_m = 0.3; x_m < size.x() - 1.8; x_m += 2.0) {
      if (random_.chance(config_.furniture_share * 0.5))
        add_box(room.low + Vector2{x_m, size.y() - 0.75}, {1.5, 0.75});
    }
    for (double y_m = 1.2; y_m < size.y() - 1.6; y_m += 1.3) {
      if (random_.chance(config_.furniture_share * 0.5))
        add_box(room.low + Vector2{0.0, y_m}, {0.45, 0.9});
    }
    if (random_.chance(config_.furniture_share)) {
      const Vector2 chair =
          room.low + 0.5 * size + Vector2{random_.uniform(-0.6, 0.6), random_.uniform(-0.6, 0.6)};
      chairs_.push_back({chair, 0.06, Material::post});
    }
  }

  void add_box(const Vector2& corner, const Vector2& size) {
    floor_.set({corner, corner + size}, false);
  }

  /// Cupboards and bins against a corridor's wall; 0.3 m deep, so that there is room to pass.
  void furnish_corridor(const Corridor& corridor) {
    const Vector2 along = (corridor.to - corridor.from).normalized();
    const Vector2 left{-along.y(), along.x()};
    const double length_m = (corridor.to - corridor.from).norm();
    for (double u_m = 3.0; u_m < length_m - 4.0; u_m += 1.5) {
      if (!random_.chance(1.5 * config_.corridor_furniture_per_m)) continue;
      const double side = random_.chance(0.5) ? 1.0 : -1.0;
      const Vector2 against_wall =
          corridor.from + u_m * along + side * 0.5 * config_.corridor_m * left;
      const Vector2 out = against_wall + random_.uniform(0.5, 1.2) * along - side * 0.3 * left;
      floor_.set(rectangle(against_wall, out), false);
    }
  }

  void connect_corridors() {
    for (const Circle& chair : chairs_) plan_.outline_in_world.circles.push_back(chair);
    std::vector<std::vector<int>> corners(plan_.columns_m.size());
    for (std::size_t column = 0; column < corners.size(); ++column) {
      for (int row = 0; row < 2; ++row) {
        corners[column].push_back(
            plan_.corridors.add_place(plan_.corner_in_world({static_cast<int>(column), row})));
      }
    }
    for (std::size_t column = 0; column < corners.size(); ++column) {
      connect_along(corners[column][0], corners[column][1]);
      for (int row = 0; row < 2 && column + 1 < corners.size(); ++row) {
        connect_along(corners[column][static_cast<std::size_t>(row)],
                      corners[column + 1][static_cast<std::size_t>(row)]);
      }
    }
  }

  void connect_along(int from, int to) {
    WalkGraph& graph = plan_.corridors;
    const Vector2 start = graph.places_in_world[static_cast<std::size_t>(from)];
    const Vector2 end = graph.places_in_world[static_cast<std::size_t>(to)];
    const int pieces = std::max(1, static_cast<int>((end - start).norm() / 6.0));
    int last = from;
    for (int i = 1; i < pieces; ++i) {
      const int next = graph.add_place(start + (end - start) * (static_cast<double>(i) / pieces));
      graph.connect(last, next);
      last = next;
    }
    graph.connect(last, to);
  }

  OfficeConfig config_;
  Random random_;
  Floor floor_;
  OfficePlan plan_;
  std::vector<Corridor> corridors_;
  std::vector<Circle> chairs_;
};

}  // namespace

Vector2 OfficePlan::corner_in_world(const OfficeCorner& corner) const {
  return {columns_m[static_cast<std::size_t>(corner.column)], corner.row == 0 ? 0.0 : depth_m};
}

OfficePlan build_office(const OfficeConfig& config, std::uint64_t seed) {
  return OfficeBuilder(config, seed).build();
}

}  // namespace slammot::simulation
