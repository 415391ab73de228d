#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/simulation/moving_object.hpp"

namespace slammot::simulation {

/// A place in the world frame.
struct PlaceInWorld {
  double x_m = 0.0;
  double y_m = 0.0;
};

/// Speeds are constant before the first time and after the last, and linear in between.
struct SpeedAt {
  double at_s = 0.0;  ///< After the first scan.
  double mps = 0.0;
};

/// An object with a scripted motion. Vehicles ignore obstacles, pedestrians give way to each other
/// and to what stands.
struct ScriptedObject {
  ObjectClass kind = ObjectClass::car;
  double length_m = 0.0;  ///< 0: usual for its class.
  double width_m = 0.0;
  std::vector<PlaceInWorld> way;   ///< Path of its centre, straight between places; stationary if
                                   ///< there is only one.
  double heading_rad = 0.0;        ///< Of a stationary object.
  double bend_m = 4.0;             ///< Corners of the way are rounded from this far before them on.
  std::vector<SpeedAt> speed;      ///< Zero after the end of the way.
  double from_s = -1e6;            ///< The object exists from this time
  double until_s = 1e6;            ///< to this time.
  bool carries_scanner = false;    ///< A further vehicle with scanners, which records its own log.
  int copies = 1;                  ///< Number of copies, with these random differences:
  double ahead_variation_m = 0.0;  ///< start up to this far along the way,
  double sideways_variation_m = 0.0;  ///< lateral offset up to this,
  double speed_variation = 0.0;       ///< relative speed difference up to this.
};

/// A recorded place with its time.
struct RecordedPlace {
  double at_s = 0.0;                  ///< After the first scan.
  geometry::Pose2 world_from_object;  ///< Centre of its box.
  double speed_mps = 0.0;
};

/// An object with a motion recorded by another simulator; it exists from its first place to its
/// last.
struct RecordedObject {
  std::string name;  ///< Name in that simulator.
  ObjectClass kind = ObjectClass::car;
  std::vector<RecordedPlace> places;  ///< Ascending at_s.
};

/// A house front, or a wall where its depth is 0.
struct ScriptedFront {
  std::vector<PlaceInWorld> along;
  double bay_m = 6.0;      ///< Mean width of bays,
  double depth_m = 1.0;    ///< and their greatest depth, to the left of the way along the front.
  double gap_share = 0.0;  ///< Share of bays without a wall.
};

enum class RowOf { post, bush, parked_car };

/// A row of stationary objects.
struct ScriptedRow {
  RowOf of = RowOf::post;
  PlaceInWorld from;
  PlaceInWorld to;
  double spacing_m = 0.0;    ///< 0: a single object, at `from`.
  double variation_m = 0.0;  ///< Largest random displacement of each object.
  double radius_m = 0.15;    ///< Of posts and bushes.
};

/// A fully scripted small scene.
struct ScriptConfig {
  ScriptedObject vehicle;
  std::vector<ScriptedObject> objects;
  std::vector<RecordedObject> recorded;
  int recorded_vehicle = -1;  ///< Index of the recorded vehicle with the scanner, in place of
                              ///< `vehicle`; -1: none.
  std::vector<ScriptedFront> fronts;
  std::vector<ScriptedRow> rows;
};

/// Stationary surfaces of the script.
Outline build_script(const ScriptConfig& config, std::uint64_t seed);

}  // namespace slammot::simulation
