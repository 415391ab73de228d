#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/metrics/clear_mot.hpp"
#include "common/metrics/hota.hpp"
#include "common/metrics/scene.hpp"
#include "common/metrics/statistics.hpp"

namespace slammot::metrics {

/// Errors of whole boxes.
struct BoxErrors {
  std::size_t rows = 0;
  double iou_median = 0.0;        ///< Intersection over union of the true and the reported box,
  double iou_lowest_tenth = 0.0;  ///< and its quantile of a tenth.
  ErrorSummary centre_m;
  ErrorSummary heading_rad;
  ErrorSummary velocity_mps;  ///< Length of the difference.
};

/// Shares of the outline seen so far from which the rows of VehicleBoxErrors::by_outline begin.
inline constexpr std::array<double, 4> kOutlineBands = {0.0, 0.2, 0.4, 0.6};

/// Of vehicles (cars, trucks, buses), in matched rows from 2 s after their first counted row on.
struct VehicleBoxErrors {
  BoxErrors all;
  std::array<BoxErrors, kOutlineBands.size()> by_outline;  ///< By TrueObject::outline_seen.
};

/// A matched row of a vehicle.
struct VehicleBoxRow {
  std::size_t scan = 0;               ///< Index of the scene,
  std::size_t object = 0;             ///< in it of the true object
  std::size_t track = 0;              ///< and of the track.
  double iou = 0.0;                   ///< Intersection over union.
  geometry::Pose2 object_from_track;  ///< Of the boxes.
  double velocity_mps = 0.0;          ///< Length of the difference.
};

/// The rows that VehicleBoxErrors sums up. Scenes, what counts of each, and the matches of
/// clear_mot, all of the same length and order.
std::vector<VehicleBoxRow> vehicle_box_rows(const std::vector<Scene>& scenes,
                                            const std::vector<CountedScene>& counted,
                                            const ClearMot& matched);

VehicleBoxErrors vehicle_box_errors(const std::vector<Scene>& scenes,
                                    const std::vector<CountedScene>& counted,
                                    const ClearMot& matched);

/// HOTA of pairs that are the same thing beyond doubt: similarity is 1 from an intersection over
/// union of 0.3 on, for people up to a distance of 0.5 m between the centres; otherwise 0.
Hota strict_hota(const std::vector<Scene>& scenes, const std::vector<CountedScene>& counted,
                 std::size_t object_count, std::size_t track_count);

/// Objects in view with enough echoes, below the rule's speed, that were at or above it before.
struct StoppedRows {
  std::size_t rows = 0;
  std::size_t covered_rows = 0;  ///< A track, occluded or not, is paired with the object.

  double covered_share() const;
};

StoppedRows stopped_rows(const std::vector<Scene>& scenes, const CountingRule& rule);

}  // namespace slammot::metrics
