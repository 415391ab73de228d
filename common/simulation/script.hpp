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

/// Speeds are held before the first time and after the last, and change evenly in between.
struct SpeedAt {
  double at_s = 0.0;                  ///< After the first scan.
  double mps = 0.0;
};

/// Something that does what the scenario says, whatever is in its way.
struct ScriptedObject {
  ObjectClass kind = ObjectClass::car;
  double length_m = 0.0;              ///< 0: usual for its class.
  double width_m = 0.0;
  std::vector<PlaceInWorld> way;      ///< Its centre's, straight from place to place; stays where there is one only.
  double heading_rad = 0.0;           ///< Of what stays.
  double bend_m = 4.0;                ///< Corners of the way are rounded from this far before them on.
  std::vector<SpeedAt> speed;         ///< Stands at its end when the way is over.
  double from_s = -1e6;               ///< In the world from here
  double until_s = 1e6;               ///< to here.
  bool carries_scanner = false;       ///< A further vehicle: it records a log of its own.
  int copies = 1;                     ///< The same again, with these differences at random:
  double ahead_variation_m = 0.0;     ///< starts up to this far along the way,
  double sideways_variation_m = 0.0;  ///< walks or drives up to this far beside it,
  double speed_variation = 0.0;       ///< is up to this share faster or slower.
};

/// Where something was at a time.
struct RecordedPlace {
  double at_s = 0.0;                  ///< After the first scan.
  geometry::Pose2 world_from_object;  ///< Centre of its box.
  double speed_mps = 0.0;
};

/// Something that does what another simulator says; in the world from its first place to its last.
struct RecordedObject {
  std::string name;                   ///< There.
  ObjectClass kind = ObjectClass::car;
  std::vector<RecordedPlace> places;  ///< Ascending at_s.
};

/// A house front, or a wall where its depth is 0.
struct ScriptedFront {
  std::vector<PlaceInWorld> along;
  double bay_m = 6.0;                 ///< Mean width of what stands out or back,
  double depth_m = 1.0;               ///< and how far at most, to the left of the way along it.
  double gap_share = 0.0;             ///< Of the bays: nothing there.
};

enum class RowOf { post, bush, parked_car };

/// Things beside each other that stand still.
struct ScriptedRow {
  RowOf of = RowOf::post;
  PlaceInWorld from;
  PlaceInWorld to;
  double spacing_m = 0.0;             ///< 0: one thing, at `from`.
  double variation_m = 0.0;           ///< Each is up to this far from its place.
  double radius_m = 0.15;             ///< Of posts and bushes.
};

/// A small scene of which everything is told.
struct ScriptConfig {
  ScriptedObject vehicle;
  std::vector<ScriptedObject> objects;
  std::vector<RecordedObject> recorded;
  int recorded_vehicle = -1;          ///< Which of these carries the scanner in place of `vehicle`; -1: none.
  std::vector<ScriptedFront> fronts;
  std::vector<ScriptedRow> rows;
};

/// Everything that stands still.
Outline build_script(const ScriptConfig& config, std::uint64_t seed);

}  // namespace slammot::simulation
