#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::config {

/// Letters to insert, to leave out or to replace: Levenshtein 1966.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name that is spelled most like the word, the first of several; nothing if more than a
/// third of the letters of the longer one differ.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& known);

/// "; the nearest one is 'side_m'", or nothing where none is near.
std::string hint_at_nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace slammot::config
