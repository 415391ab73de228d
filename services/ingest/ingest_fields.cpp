#include "services/ingest/ingest_fields.hpp"

namespace slammot::ingest {

const config::FieldTable<IngestConfig>& ingest_fields() {
  using C = IngestConfig;
  using config::Range;
  static const config::FieldTable<C> table = {
      {"window_scans", &C::window_scans, "At speed max: scans sent whose labels have not come back.", Range{1, 4}},
      {"resend_after_s", &C::resend_after_s, "At speed max: without labels for so long, what is in flight is sent again.",
       Range{0.05, 60.0}},
      {"wait_for_services_s", &C::wait_for_services_s, "Before the first scan, for the other services to be there.",
       Range{0.0, 3600.0}},
      {"graph_patience_s", &C::graph_patience_s, "At speed max: a finished submap's place in the graph is waited for this long.",
       Range{0.0, 600.0}},
      {"scanner_id", &C::scanner_id, "Names the scanner; its frame is laser_<scanner_id>."},
      {"fallback_field_of_view_rad", &C::fallback_field_of_view_rad, "First to last beam, where the log does not say.",
       Range{0.01, 6.2832}},
      {"fallback_laser_ahead_m", &C::fallback_laser_ahead_m, "Of the laser on the base, where the log does not say.", Range{-100.0, 100.0}},
      {"fallback_laser_left_m", &C::fallback_laser_left_m, "Of the laser on the base, where the log does not say.", Range{-100.0, 100.0}},
      {"fallback_laser_heading_rad", &C::fallback_laser_heading_rad, "Where the laser looks, counter-clockwise from straight ahead, where the log does not say.",
       Range{-6.2832, 6.2832}},
      {"sweep_s", &C::sweep_s, "First to last beam's firing, where the log does not show it; 0: at once.", Range{0.0, 1.0}},
  };
  return table;
}

}  // namespace slammot::ingest
