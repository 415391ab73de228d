#pragma once

#include <numbers>
#include <string>

namespace slammot::ingest {

struct IngestConfig {
  int window_scans = 1;         ///< At speed max: greatest number of scans without labels.
  double resend_after_s = 1.0;  ///< At speed max: time without labels after which pending scans are
                                ///< sent again.
  double wait_for_services_s = 20.0;  ///< Longest wait before the first scan for localization,
                                      ///< detection and tracking.
  /// At speed max: longest wait for a finished submap in the graph. A search everywhere takes up to
  /// 20 s.
  double graph_patience_s = 30.0;
  std::string scanner_id = "front";
  double fallback_field_of_view_rad = std::numbers::pi;  ///< From the first to the last beam, if
                                                         ///< the log does not state it.
  double fallback_laser_ahead_m = 0.0;  ///< Position of the laser in base, if the log does not
                                        ///< state it.
  double fallback_laser_left_m = 0.0;
  double fallback_laser_heading_rad = 0.0;  ///< Heading of the laser in base, if the log does not
                                            ///< state it.
  double sweep_s = 0.0;  ///< Time from the first to the last beam, if the log does not show it; 0:
                         ///< simultaneous.
};

}  // namespace slammot::ingest
