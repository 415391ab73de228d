#include "services/ingest/ingest_fields.hpp"

namespace slammot::ingest {
namespace {

using config::FieldTable;
using config::Group;
using config::in_group;
using config::Range;
using C = IngestConfig;

FieldTable<C> operation_fields() {
  return in_group<C>(Group::operation,
                     {
                         {"wait_for_services_s",
                          &C::wait_for_services_s,
                          "Longest wait for the other services before the first scan.",
                          Range{0.0, 3600.0},
                          {"The first scans are lost if services start slowly.",
                           "A drive without one of the services begins late."}},
                         {"graph_patience_s",
                          &C::graph_patience_s,
                          "At speed max: longest wait for a finished submap in the graph.",
                          Range{0.0, 600.0},
                          {"Results depend on the speed of loop closing.",
                           "A failed loop closing delays each submap by this time."}},
                     });
}

FieldTable<C> sensor_fields() {
  return in_group<C>(
      Group::sensor,
      {
          {"scanner_id", &C::scanner_id, "Name of the scanner; its frame is laser_<scanner_id>."},
          {"fallback_field_of_view_rad",
           &C::fallback_field_of_view_rad,
           "Angle from the first to the last beam, if the log does not state it.",
           Range{0.01, 6.2832},
           {"Walls are bent, and turns are underestimated.",
            "Walls are bent, and turns are overestimated."}},
          {"fallback_laser_ahead_m",
           &C::fallback_laser_ahead_m,
           "Position of the laser forward of base, if the log does not state it.",
           Range{-100.0, 100.0},
           {"The lever arm in turns is underestimated: the map is blurred.",
            "The lever arm is overestimated: the map is blurred."}},
          {"fallback_laser_left_m",
           &C::fallback_laser_left_m,
           "Position of the laser to the left of base, if the log does not state it.",
           Range{-100.0, 100.0},
           {"The map is blurred in turns.", "The map is blurred in turns."}},
          {"fallback_laser_heading_rad",
           &C::fallback_laser_heading_rad,
           "Heading of the laser in base, counter-clockwise, if the log does not state it.",
           Range{-6.2832, 6.2832},
           {"The estimated motion drifts to one side.",
            "The estimated motion drifts to the other side."}},
          {"sweep_s",
           &C::sweep_s,
           "Time from the first to the last beam, if the log does not show it; 0: "
           "simultaneous.",
           Range{0.0, 1.0},
           {"Walls are rotated and shifted during motion.",
            "Walls are rotated and shifted during motion, in the other direction."}},
      });
}

}  // namespace

const FieldTable<IngestConfig>& ingest_fields() {
  static const FieldTable<C> table = config::joined<C>({operation_fields(), sensor_fields()});
  return table;
}

}  // namespace slammot::ingest
