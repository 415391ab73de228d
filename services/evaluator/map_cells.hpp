#pragma once

#include "common/files/map_image.hpp"
#include "common/metrics/map_quality.hpp"

namespace slammot::evaluator {

/// The states of an SO-map's pixels.
metrics::OccupancyCells cells_of(const files::MapImage& image);

}  // namespace slammot::evaluator
