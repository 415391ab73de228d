#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/flow/tracked_objects.hpp"
#include "common/wire/decoded.hpp"
#include "idl/tracking.h"

namespace slammot::wire {

inline constexpr std::size_t kMostObjects = 192;
inline constexpr std::size_t kMostContourPoints = 64;       ///< Of one object.
inline constexpr std::size_t kMostPredictedPositions = 16;  ///< Of one object.

/// Puts tracks on the wire; keeps its buffers.
class TrackedObjectsEncoder {
 public:
  /// scan_published_ns: system clock of the source, 0 where it is unknown. The result is valid
  /// until the next call. If there are too many objects, contours are subsampled and paths
  /// shortened for all alike. Of more than kMostObjects, confirmed and then more probable objects
  /// are kept.
  const slammot_TrackedObjects& encode(std::string_view vehicle_id,
                                       const flow::TrackedObjects& objects,
                                       std::int64_t scan_published_ns = 0);

 private:
  void choose(const std::vector<flow::TrackedObject>& objects);
  void encode_contour(const flow::TrackedObject& object, slammot_TrackedObject& sample);
  void encode_path(const flow::TrackedObject& object, slammot_TrackedObject& sample);

  slammot_TrackedObjects sample_{};
  std::vector<const flow::TrackedObject*> chosen_;
  std::vector<slammot_TrackedObject> objects_;
  std::vector<slammot_Point2f> contour_points_;
  std::vector<slammot_PredictedPosition> path_points_;
};

Decoded<flow::TrackedObjects> decode(const slammot_TrackedObjects& sample);

}  // namespace slammot::wire
