#pragma once

#include "common/flow/scan_labels.hpp"
#include "common/grids/evidence_grid.hpp"

namespace slammot::localization {

/// What a labelled point does to the maps.
inline grids::Echo echo_of(flow::PointLabel label) {
  switch (label) {
    case flow::PointLabel::kNoEcho: return grids::Echo::kNone;
    case flow::PointLabel::kMoving: return grids::Echo::kMoving;
    case flow::PointLabel::kStationary:
    case flow::PointLabel::kUnknown: break;  // nothing contradicts that it stands there
  }
  return grids::Echo::kStationary;
}

}  // namespace slammot::localization
