#pragma once

#include <string>

#include "services/slammot/replay_comparison.hpp"

namespace slammot {

/// A line for each topic and for each field that differs, and the first difference.
std::string describe(const ReplayComparison& comparison);

}  // namespace slammot
