#include "services/ingest/ingest_fields.hpp"

namespace slammot::ingest {

const config::FieldTable<IngestConfig>& ingest_fields() {
  using C = IngestConfig;
  using config::Group;
  using config::in_group;
  using config::Range;
  static const config::FieldTable<C> table = config::joined<C>({
      in_group<C>(
          Group::operation,
          {
              {"wait_for_services_s",
               &C::wait_for_services_s,
               "Before the first scan, for the other services to be there.",
               Range{0.0, 3600.0},
               {"The first scans are lost where services start slowly.",
                "A drive without one of the services begins late."}},
              {"graph_patience_s",
               &C::graph_patience_s,
               "At speed max: a finished submap's place in the graph is waited for this long.",
               Range{0.0, 600.0},
               {"Results depend on how fast loop closing is.",
                "Without loop closing the drive stops as long at each submap."}},
          }),
      in_group<C>(
          Group::sensor,
          {
              {"scanner_id", &C::scanner_id, "Names the scanner; its frame is laser_<scanner_id>."},
              {"fallback_field_of_view_rad",
               &C::fallback_field_of_view_rad,
               "First to last beam, where the log does not say.",
               Range{0.01, 6.2832},
               {"Walls bend, and scans tell of less turning than there was.",
                "Walls bend, and scans tell of more turning than there was."}},
              {"fallback_laser_ahead_m",
               &C::fallback_laser_ahead_m,
               "Of the laser on the base, where the log does not say.",
               Range{-100.0, 100.0},
               {"In turns the scanner swings more than assumed: the map smears.",
                "The same, the other way."}},
              {"fallback_laser_left_m",
               &C::fallback_laser_left_m,
               "Of the laser on the base, where the log does not say.",
               Range{-100.0, 100.0},
               {"The map smears in turns.", "The same, the other way."}},
              {"fallback_laser_heading_rad",
               &C::fallback_laser_heading_rad,
               "Where the laser looks, counter-clockwise from straight ahead, where the log does "
               "not say.",
               Range{-6.2832, 6.2832},
               {"The vehicle seems to drift to one side.", "To the other side."}},
              {"sweep_s",
               &C::sweep_s,
               "First to last beam's firing, where the log does not show it; 0: at once.",
               Range{0.0, 1.0},
               {"In turns and at speed walls are rotated and shifted.",
                "The same, the other way."}},
          }),
  });
  return table;
}

}  // namespace slammot::ingest
