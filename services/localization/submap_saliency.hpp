#pragma once

#include "common/flow/submap.hpp"

namespace slammot::localization {

/// Object saliency score of a submap's surfels, Wang 2004, Eq. (3.11). Displacements of 0.5 m, and
/// of a heading that moves its farthest surfels as far; 0 for a submap without surfels. The same
/// for the same submap.
double saliency_of(const flow::Submap& submap);

}  // namespace slammot::localization
