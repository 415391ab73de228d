#pragma once

namespace slammot::geometry {

constexpr double squared(double value) { return value * value; }

}  // namespace slammot::geometry
