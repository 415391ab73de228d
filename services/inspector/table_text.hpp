#pragma once

#include <string>
#include <vector>

namespace slammot::inspector {

/// Text in columns, with a line of titles. Columns that `right_from` or a later one are aligned to
/// the right.
std::string table_text(const std::vector<std::string>& titles,
                       const std::vector<std::vector<std::string>>& rows, std::size_t right_from);

}  // namespace slammot::inspector
