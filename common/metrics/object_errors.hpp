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
  std::size_t rows = 0;          ///< Objects that counted, once a scan.
  std::size_t matched_rows = 0;
  double recall = 0.0;
  double right_class = 0.0;      ///< Share of the matched rows.
  std::map<std::string, std::size_t> reported_as;  ///< Matched rows by the class that was reported.
  ErrorSummary centre_m;         ///< Between the boxes' centres.
  ErrorSummary velocity_mps;     ///< Length of the difference.
  ErrorSummary heading_rad;
  ErrorSummary length_m;
  ErrorSummary width_m;
  NeesSummary position_nees;     ///< Of the centre, once a second and object.
};

/// Objects whose distance from the vehicle is in [from_m, to_m).
struct DistanceBand {
  double from_m = 0.0;
  double to_m = 0.0;
  std::size_t false_rows = 0;    ///< Tracks there that matched nothing.
  ObjectErrors errors;
};

struct ObjectErrorTables {
  ObjectErrors all;
  std::map<std::string, ObjectErrors> by_class;
  std::vector<DistanceBand> by_distance;
  ErrorSummary detection_delay_s;      ///< From the first row that counted to the first that matched, of what matched at all.
  std::size_t never_detected = 0;
};

/// Scenes, what counts of each, and the matches of clear_mot, all of the same length and order. Bands begin at the given
/// distances, the last one ends at the rule's range.
ObjectErrorTables object_errors(const std::vector<Scene>& scenes, const std::vector<CountedScene>& counted, const ClearMot& matched,
                                const std::vector<double>& band_starts_m, double range_m);

/// Truth's words for classes and those of tracks ("truck_or_bus") that mean the same.
bool is_same_class(const std::string& true_class, const std::string& reported_class);

}  // namespace slammot::metrics
