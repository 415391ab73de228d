#pragma once

#include <string_view>
#include <vector>

namespace slammot::evaluator {

/// A point of a letter; y upwards.
struct FontPoint {
  double x = 0.0;
  double y = 0.0;
};

using FontStroke = std::vector<FontPoint>;  ///< Of one point: a dot.

/// Strokes of a line of text from x 0 on, on the baseline y 0, with capitals of height 1.
/// Characters that the font lacks are drawn as a box.
std::vector<FontStroke> strokes_of(std::string_view text);

/// Width of the line in the same unit.
double width_of(std::string_view text);

}  // namespace slammot::evaluator
