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
  kStanding,  ///< On an object too slow to count: either label is right,
  kDontCare,  ///< as beside a box, or far away.
};

struct BeamTruth {
  BeamKind kind = BeamKind::kNoEcho;
  std::size_t object = 0;  ///< Where kind is kMoving: which, as TrueObject::object.
};

/// What each echo truly came from: an object in motion where it lies within 0.3 m of its box, what stands still where no box
/// is within 1 m. Of more echoes near a box than the object sent, those nearest to it are taken. Points in world, one a beam, none for no echo; points farther than the rule's range are don't care.
std::vector<BeamTruth> beam_truth(const std::vector<std::optional<geometry::Vector2>>& points_in_world_m, const Scene& scene, const CountingRule& rule);

/// What a beam hit, as a simulator knows it.
struct BeamHit {
  enum class On : unsigned char { kNothing, kStationary, kObject, kSeveral };
  On on = On::kNothing;
  std::size_t object = 0;  ///< Where it is kObject: which, as TrueObject::object.
};

/// The same where it is known what each beam hit: several things at once are don't care. As many hits as points.
std::vector<BeamTruth> beam_truth(const std::vector<std::optional<geometry::Vector2>>& points_in_world_m, const std::vector<BeamHit>& hits, const Scene& scene,
                                  const CountingRule& rule);

/// Sums over scans of how labels fit the truth.
struct DetectionCounts {
  std::size_t moving_as_moving = 0;       ///< Truly moving points with the label moving,
  std::size_t moving_as_stationary = 0;
  std::size_t moving_as_unknown = 0;
  std::size_t stationary_as_moving = 0;   ///< and what stands still.
  std::size_t stationary_as_stationary = 0;
  std::size_t stationary_as_unknown = 0;
  std::size_t objects = 0;                ///< Moving objects with enough points, once a scan,
  std::size_t detected_objects = 0;       ///< with more than half of their decided points labelled moving.
  std::size_t moving_runs = 0;            ///< Neighbouring beams labelled moving, enough of them,
  std::size_t right_runs = 0;             ///< of which more than half are truly moving.

  double moving_precision() const;
  double moving_recall() const;
  double stationary_precision() const;
  double stationary_recall() const;
  double segment_precision() const;
  double segment_recall() const;
};

/// Adds one scan. Labels are a letter a beam: 's' stationary, 'm' moving, '?' unknown, '-' no echo; as many as truths.
/// An object or run has enough points with least_points.
DetectionCounts add_scan(DetectionCounts counts, const std::vector<BeamTruth>& truth, std::string_view labels, std::size_t least_points);

}  // namespace slammot::metrics
