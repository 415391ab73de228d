#pragma once

#include "common/sensing/segmentation.hpp"

namespace slammot::detection {

struct DetectionConfig {
  sensing::SegmentationConfig segmentation;
  double longest_mover_m = 16.0;  ///< Longest segment that is labelled moving.
  double range_noise_m = 0.03;    ///< One sigma of a range at range zero.
};

}  // namespace slammot::detection
