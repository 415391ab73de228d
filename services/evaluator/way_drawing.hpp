#pragma once

#include <vector>

#include "common/traffic/way.hpp"
#include "services/evaluator/scene_drawing.hpp"

namespace slammot::evaluator {

/// Name of a colour of the page's theme.
const char* colour_of(traffic::Mover mover);

/// Lanes, cycle lanes and walkways in the colours of cars, bicycles and pedestrians: the width that
/// is used, the middle, and on those with a direction an arrow in each piece. The less certain, the
/// fainter.
void add_ways(const std::vector<traffic::Way>& ways, const GroundView& view, const PageTheme& theme,
              Drawing& drawing);

}  // namespace slammot::evaluator
