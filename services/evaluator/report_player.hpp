#pragma once

#include <string>
#include <string_view>

#include "services/evaluator/result_files.hpp"

namespace slammot::evaluator {

/// An embedded file of page/, or of what is made of it; empty if there is no such file.
std::string_view page_file(std::string_view name);

/// HTML with styles of the live page and of reports.
std::string page_head(const std::string& title);

/// HTML of the player with the drive in it: the elements, the data and the script.
std::string player_of(const RunResult& result);

/// A page that holds nothing but the player, for a frame of another page.
std::string player_page(const RunResult& result, const std::string& title);

/// Times of the drive with a doubtful pose as links to the player, in words.
std::string doubts_section(const RunResult& result);

}  // namespace slammot::evaluator
