#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "common/metrics/scene.hpp"

namespace slammot::metrics {

enum class BeamKind : unsigned char {
  kNoEcho,
  kStationary,
  kMoving,
  kStanding,  ///< On an object too slow to count: either label is correct.
  kDontCare,  ///< Don't care: beside a box, or far away.
};

struct BeamTruth {
  BeamKind kind = BeamKind::kNoEcho;
  std::size_t object = 0;  ///< If kind is kMoving: TrueObject::object.
};

/// True source of each echo: a moving object if the echo is within 0.3 m of its box, stationary if
/// no box is within 1 m. If more echoes are near a box than the object has, the nearest ones are
/// assigned. Points in world, one a beam, none for no echo; points beyond the rule's range are
/// don't care.
std::vector<BeamTruth> beam_truth(
    const std::vector<std::optional<geometry::Vector2>>& points_in_world_m, const Scene& scene,
    const CountingRule& rule);

/// True source of a beam's echo, from a simulator.
struct BeamHit {
  enum class On : unsigned char { kNothing, kStationary, kObject, kSeveral };
  On on = On::kNothing;
  std::size_t object = 0;  ///< If it is kObject: TrueObject::object.
};

/// The same with known sources: mixed pixels are don't care. One hit a point.
std::vector<BeamTruth> beam_truth(
    const std::vector<std::optional<geometry::Vector2>>& points_in_world_m,
    const std::vector<BeamHit>& hits, const Scene& scene, const CountingRule& rule);

/// Counts over scans of labels against truth.
struct DetectionCounts {
  std::size_t moving_as_moving = 0;  ///< Moving points labelled moving.
  std::size_t moving_as_stationary = 0;
  std::size_t moving_as_unknown = 0;
  std::size_t stationary_as_moving = 0;  ///< Stationary points labelled moving.
  std::size_t stationary_as_stationary = 0;
  std::size_t stationary_as_unknown = 0;
  std::size_t objects = 0;           ///< Moving objects with enough points, counted in each scan.
  std::size_t detected_objects = 0;  ///< Of these, with more than half of the decided points
                                     ///< labelled moving.
  std::size_t moving_runs = 0;  ///< Runs of neighbouring beams labelled moving, with enough points.
  std::size_t right_runs = 0;   ///< Of these, with more than half of the points truly moving.

  double moving_precision() const;
  double moving_recall() const;
  double stationary_precision() const;
  double stationary_recall() const;
  double segment_precision() const;
  double segment_recall() const;
};

/// Adds one scan. Labels are a letter a beam: 's' stationary, 'm' moving, '?' unknown, '-' no echo;
/// as many as truths. An object or run has enough points with least_points.
DetectionCounts add_scan(DetectionCounts counts, const std::vector<BeamTruth>& truth,
                         std::string_view labels, std::size_t least_points);

}  // namespace slammot::metrics
