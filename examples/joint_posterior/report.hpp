#pragma once

#include <string>

#include "examples/joint_posterior/study.hpp"

namespace slammot::joint_posterior {

/// Markdown table of all methods against the number of movers, means over this many seeds.
std::string table(int seeds, const Clock& now_s);

/// The page with the table between its two markers replaced; empty without markers.
std::string with_table(const std::string& page, const std::string& table);

}  // namespace slammot::joint_posterior
