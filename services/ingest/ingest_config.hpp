#pragma once

#include <numbers>
#include <string>

namespace slammot::ingest {

struct IngestConfig {
  int window_scans = 1;         ///< At speed max: scans sent whose labels have not come back.
  double resend_after_s = 1.0;  ///< At speed max: without labels for so long, what is in flight is
                                ///< sent again.
  double wait_for_services_s = 20.0;  ///< Before the first scan, for localization, detection and
                                      ///< tracking to be there.
  double graph_patience_s = 30.0;     ///< At speed max: a finished submap's place in the graph is
                                   ///< waited for this long. Looking everywhere takes up to 20 s.
  std::string scanner_id = "front";
  double fallback_field_of_view_rad = std::numbers::pi;  ///< First to last beam, where the log does
                                                         ///< not say.
  double fallback_laser_ahead_m = 0.0;  ///< Where the laser is on the base, where the log does not
                                        ///< say,
  double fallback_laser_left_m = 0.0;
  double fallback_laser_heading_rad = 0.0;  ///< and where it looks, counter-clockwise from straight
                                            ///< ahead.
  double sweep_s = 0.0;  ///< First to last beam's firing, where the log does not show it; 0: at
                         ///< once.
};

}  // namespace slammot::ingest
