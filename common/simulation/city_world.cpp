#include "common/simulation/city_world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/simulation/random.hpp"

namespace slammot::simulation {
namespace {

using geometry::Vector2;

/// A block's side seen from the street: u runs along the front, v into the block.
struct Side {
  Vector2 corner_in_plan;
  Vector2 along;
  Vector2 inward;
  double length_m = 0.0;

  Vector2 at(double u_m, double v_m) const { return corner_in_plan + u_m * along + v_m * inward; }
};

struct Rectangle {
  double west_m, south_m, east_m, north_m;
};

class CityBuilder {
 public:
  CityBuilder(const StreetPlan& plan, std::uint64_t seed)
      : plan_(plan), random_(seed ^ 0x5eedULL, Purpose::world) {}

  Outline build() {
    for (int row = -1; row < plan_.rows(); ++row) {
      for (int column = -1; column < plan_.columns(); ++column) add_block(column, row);
    }
    for (int junction = 0; junction < plan_.junction_count(); ++junction)
      add_street_furniture(junction);
    return std::move(outline_);
  }

 private:
  const CityConfig& config() const { return plan_.config(); }

  void add_block(int column, int row) {
    const double front_m = config().front_m;
    const Rectangle block{plan_.block_west_m(column) + front_m, plan_.block_south_m(row) + front_m,
                          plan_.block_west_m(column + 1) - front_m,
                          plan_.block_south_m(row + 1) - front_m};
    if (random_.chance(config().park_share)) {
      add_park(block);
    } else {
      add_houses(block);
    }
  }

  void add_park(const Rectangle& park) {
    const auto trees =
        static_cast<int>((park.east_m - park.west_m) * (park.north_m - park.south_m) / 90.0);
    for (int i = 0; i < trees; ++i) {
      const Vector2 place{random_.uniform(park.west_m, park.east_m),
                          random_.uniform(park.south_m, park.north_m)};
      const bool bush = random_.chance(0.3);
      add_circle(place, bush ? random_.uniform(0.5, 1.3) : random_.uniform(0.12, 0.4),
                 bush ? Material::foliage : Material::post);
    }
  }

  void add_houses(const Rectangle& block) {
    const double width_m = block.east_m - block.west_m;
    const double height_m = block.north_m - block.south_m;
    const double depth_m = std::min(12.0, 0.3 * std::min(width_m, height_m));
    const double inner_m = height_m - 2.0 * depth_m - 4.0;
    add_row_of_houses({{block.west_m, block.south_m}, {1, 0}, {0, 1}, width_m}, depth_m);
    add_row_of_houses({{block.east_m, block.north_m}, {-1, 0}, {0, -1}, width_m}, depth_m);
    add_row_of_houses({{block.west_m, block.north_m - depth_m - 2.0}, {0, -1}, {1, 0}, inner_m},
                      depth_m);
    add_row_of_houses({{block.east_m, block.south_m + depth_m + 2.0}, {0, 1}, {-1, 0}, inner_m},
                      depth_m);
  }

  void add_row_of_houses(const Side& side, double depth_m) {
    double u_m = 0.0;
    while (u_m < side.length_m - 5.0) {
      if (random_.chance(config().gap_share)) {
        const double gap_m = std::min(side.length_m - u_m, random_.uniform(2.5, 16.0));
        if (gap_m > 8.0) add_car_park(side, u_m, gap_m);
        u_m += gap_m;
        continue;
      }
      double width_m = random_.uniform(7.0, 22.0);
      if (side.length_m - u_m - width_m < 6.0) width_m = side.length_m - u_m;
      add_house(side, u_m, width_m, depth_m);
      u_m += width_m;
    }
  }

  void add_house(const Side& side, double u_m, double width_m, double depth_m) {
    const double setback_m =
        random_.chance(0.5) ? random_.uniform(0.0, 0.6) : random_.uniform(0.6, 3.5);
    std::vector<Vector2> corners{side.at(u_m, setback_m)};
    double position_m = random_.uniform(1.0, 3.0);
    while (position_m < width_m - 3.5) {
      // Bays stand out, entrances stand back; both stop the front from being one straight line.
      const bool bay = setback_m > 0.5 && random_.chance(0.5);
      const double feature_m = bay ? random_.uniform(1.5, 3.0) : random_.uniform(1.0, 2.2);
      const double v_m =
          setback_m + (bay ? -random_.uniform(0.2, 0.5) : random_.uniform(0.15, 0.9));
      corners.push_back(side.at(u_m + position_m, setback_m));
      corners.push_back(side.at(u_m + position_m, v_m));
      corners.push_back(side.at(u_m + position_m + feature_m, v_m));
      corners.push_back(side.at(u_m + position_m + feature_m, setback_m));
      position_m += feature_m + random_.uniform(2.0, 9.0);
    }
    corners.push_back(side.at(u_m + width_m, setback_m));
    corners.push_back(side.at(u_m + width_m, depth_m));
    corners.push_back(side.at(u_m, depth_m));
    add_polygon(outline_, plan_.world_from_plan(std::move(corners)), Material::wall);
  }

  /// Cars that stand side by side, noses in, in a gap between houses.
  void add_car_park(const Side& side, double u_m, double gap_m) {
    for (double place_m = 1.5; place_m < gap_m - 1.5; place_m += 2.7) {
      if (random_.chance(0.35)) continue;
      add_parked_car(side.at(u_m + place_m, random_.uniform(3.0, 4.5)), side.inward);
    }
  }

  void add_street_furniture(int junction) {
    const Vector2 centre = plan_.junction_in_plan(plan_.junction(junction));
    for (int d = 0; d < kDirections; ++d) {
      const auto direction = static_cast<Direction>(d);
      const Vector2 along = unit_vector(direction);
      const Vector2 right = unit_vector(turned_left(direction, -1));
      add_circle(centre + 6.8 * (along + right), 0.08, Material::post);  // signal pole
      const auto next = plan_.neighbour(plan_.junction(junction), direction);
      if (!next) continue;
      const double length_m = (plan_.junction_in_plan(*next) - centre).norm();
      add_kerb({centre, along, right, length_m});
    }
  }

  /// Parked cars, trees and lamps on the right of one direction of a street; v is measured from its
  /// centre line.
  void add_kerb(const Side& street) {
    constexpr double kClearOfJunction_m = 17.0;
    const double end_m = street.length_m - kClearOfJunction_m;
    double u_m = kClearOfJunction_m + random_.uniform(0.0, 6.0);
    bool run_of_cars = random_.chance(config().parked_share);
    while (u_m < end_m - 3.0) {
      if (run_of_cars)
        add_parked_car(street.at(u_m + 2.3, config().parking_offset_m), street.along);
      u_m += run_of_cars ? random_.uniform(5.1, 6.2) : random_.uniform(5.0, 9.0);
      // A run of cars goes on for four on average; the share of runs is what the configuration
      // says.
      if (random_.chance(0.25)) run_of_cars = random_.chance(config().parked_share);
    }
    add_posts(street, end_m, config().tree_spacing_m, 0.7, {0.1, 0.25});
    add_posts(street, end_m, config().lamp_spacing_m, 0.4, {0.06, 0.09});
  }

  struct RadiusRange {
    double low_m, high_m;
  };

  void add_posts(const Side& street, double end_m, double spacing_m, double behind_curb_m,
                 RadiusRange radius) {
    for (double u_m = 14.0 + random_.uniform(0.0, spacing_m); u_m < end_m;
         u_m += spacing_m * random_.uniform(0.7, 1.5)) {
      add_circle(street.at(u_m, config().curb_m + behind_curb_m),
                 random_.uniform(radius.low_m, radius.high_m), Material::post);
    }
  }

  void add_circle(const Vector2& centre_in_plan, double radius_m, Material material) {
    outline_.circles.push_back({plan_.world_from_plan(centre_in_plan), radius_m, material});
  }

  void add_parked_car(const Vector2& centre_in_plan, const Vector2& heading_in_plan) {
    const Vector2 centre = plan_.world_from_plan(centre_in_plan);
    const Vector2 nose = plan_.world_from_plan(Vector2(centre_in_plan + heading_in_plan)) - centre;
    const double heading_rad = std::atan2(nose.y(), nose.x()) + 0.02 * random_.normal();
    std::vector<Vector2> corners =
        cut_rectangle(random_.uniform(3.9, 4.8), random_.uniform(1.68, 1.86), 0.3);
    for (Vector2& corner : corners)
      corner = geometry::Pose2{centre.x(), centre.y(), heading_rad} * corner;
    add_polygon(outline_, corners, Material::parked_car);
  }

  const StreetPlan& plan_;
  Random random_;
  Outline outline_;
};

}  // namespace

Outline build_city(const StreetPlan& plan, std::uint64_t seed) {
  return CityBuilder(plan, seed).build();
}

std::vector<Segment> true_segments(const Outline& outline_in_world) {
  std::vector<Segment> segments = outline_in_world.segments;
  Outline octagons;
  for (const Circle& circle : outline_in_world.circles) {
    std::vector<Vector2> corners;
    for (int i = 0; i < 8; ++i) {
      const double angle_rad = 0.25 * std::numbers::pi * i;
      corners.push_back(circle.centre +
                        circle.radius_m * Vector2{std::cos(angle_rad), std::sin(angle_rad)});
    }
    add_polygon(octagons, corners, Material::post);
  }
  segments.insert(segments.end(), octagons.segments.begin(), octagons.segments.end());
  return segments;
}

}  // namespace slammot::simulation
