#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "common/metrics/clear_mot.hpp"
#include "common/metrics/nees.hpp"
#include "common/metrics/scene.hpp"
#include "common/metrics/statistics.hpp"

namespace slammot::metrics {

/// Of the matched rows of some objects.
struct ObjectErrors {
  std::size_t rows = 0;  ///< Counted objects, once a scan.
  std::size_t matched_rows = 0;
  double recall = 0.0;
  double right_class = 0.0;                        ///< Share of the matched rows.
  std::map<std::string, std::size_t> reported_as;  ///< Matched rows by reported class.
  ErrorSummary centre_m;                           ///< Between the boxes' centres.
  ErrorSummary velocity_mps;                       ///< Length of the difference.
  ErrorSummary heading_rad;
  ErrorSummary length_m;
  ErrorSummary width_m;
  NeesSummary position_nees;  ///< Of the centre, once a second and object.
};

/// Objects whose distance from the vehicle is in [from_m, to_m).
struct DistanceBand {
  double from_m = 0.0;
  double to_m = 0.0;
  std::size_t false_rows = 0;  ///< Tracks in the band without a match.
  ObjectErrors errors;
};

struct ObjectErrorTables {
  ObjectErrors all;
  std::map<std::string, ObjectErrors> by_class;
  std::vector<DistanceBand> by_distance;
  ErrorSummary detection_delay_s;  ///< From the first counted row to the first matched one, over
                                   ///< matched objects.
  std::size_t never_detected = 0;
};

/// Scenes, what counts of each, and the matches of clear_mot, all of the same length and order.
/// Bands begin at the given distances, the last one ends at the rule's range.
ObjectErrorTables object_errors(const std::vector<Scene>& scenes,
                                const std::vector<CountedScene>& counted, const ClearMot& matched,
                                const std::vector<double>& band_starts_m, double range_m);

/// Maps class names of the truth to those of tracks, such as "truck_or_bus".
bool is_same_class(const std::string& true_class, const std::string& reported_class);

}  // namespace slammot::metrics
