#pragma once

#include <cstdint>
#include <string>

namespace slammot::motion_study {

/// Markdown: one table a maneuver, one row a method, means over the seeds 1, 2, ...
std::string tables(int seeds);

/// CSV of one run of every method over every maneuver: what Figures 4.2 to 4.18 draw.
std::string traces(std::uint64_t seed);

}  // namespace slammot::motion_study
