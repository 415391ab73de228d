#pragma once

#include "services/tracking/centre_measurement.hpp"
#include "services/tracking/footprint.hpp"
#include "services/tracking/observation.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// One sigma of the wandering of a centre without known sides, as a share of the span.
inline constexpr double kBlobNoiseShare = 0.2;

/// Extent of an object without straight sides: length and width are equal.
struct Blob : Footprint {
  bool was_seen_whole = false;  ///< Once both ends were visible in one scan.
};

struct BlobMeasurement : CentreMeasurement {
  Blob blob;  ///< After the measurement.
};

/// Mean of the echoes, moved behind the surface by half the depth of a pedestrian. Does not depend
/// on the prediction.
BlobMeasurement measure_blob(const Blob& blob, const Observation& observation,
                             const TrackingConfig& config);

}  // namespace slammot::tracking
