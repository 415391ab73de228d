#include "services/localization/map_fields.hpp"

namespace slammot::localization {
namespace {

using config::FieldTable;
using config::Range;

FieldTable<LocalMapConfig> size_fields() {
  using C = LocalMapConfig;
  return {
      {"side_m",
       &C::side_m,
       "Side of the square held around the vehicle.",
       Range{10.0, 1000.0},
       {"Distant echoes find no map to match.", "Memory grows with the square."}},
      {"cell_size_m",
       &C::cell_size_m,
       "Edge of a cell of SO-map and MO-map.",
       Range{0.02, 1.0},
       {"Memory and time grow, and cells are seen too rarely.",
        "Doors close, and pedestrians beside walls are not seen to move."}},
      {"surfel_size_m",
       &C::surfel_size_m,
       "Edge of the cells whose echoes are averaged for matching.",
       Range{0.02, 2.0},
       {"Normals are noisy.", "Corners are rounded, poses less accurate."}},
      {"new_map_after_m",
       &C::new_map_after_m,
       "Distance from the map's centre at which a new map begins.",
       Range{1.0, 500.0},
       {"Many small submaps, each too poor to be recognised.",
        "Drift within a submap that no closure corrects."}},
      {"new_map_after_travel_m",
       &C::new_map_after_travel_m,
       "Distance travelled in a map after which a new one begins.",
       Range{1.0, 1e4},
       {"Many small submaps, each too poor to be recognised.",
        "Drift within a submap that no closure corrects."}},
  };
}

FieldTable<LocalMapConfig> evidence_fields() {
  using C = LocalMapConfig;
  return {
      {"no_echo_free_m",
       &C::no_echo_free_m,
       "Length of a beam without echo that is free, where echoes of the drive reach as far.",
       Range{0.0, 200.0},
       {"Movers in open space are detected late.",
        "Dark bodies and glass are erased from the map."}},
      {"end_cell_tolerance_m",
       &C::end_cell_tolerance_m,
       "An occupied cell this near explains an echo.",
       Range{0.0, 5.0},
       {"Walls seem to move where the pose is a little off.",
        "Pedestrians beside walls are taken for the wall."}},
  };
}

}  // namespace

FieldTable<LocalMapConfig> map_fields() {
  return in_group(config::Group::map,
                  config::joined<LocalMapConfig>({size_fields(), evidence_fields()}));
}

}  // namespace slammot::localization
