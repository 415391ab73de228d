#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::config {

/// Letters to insert, to leave out or to replace: Levenshtein 1966.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name that is spelled most like the word; the first of several. Precondition: there is
/// one.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace slammot::config
