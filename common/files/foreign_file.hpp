#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "common/files/result.hpp"

namespace slammot::files {

/// What a file is that is no log, by its first bytes, and what to do with it: "compressed by xz:
/// unpack it first". Nothing for what may be a log.
std::optional<std::string_view> foreign_content(std::string_view first_bytes);

/// One line about a path that cannot be a log: standard input, a pipe, a folder without a drive, a
/// file of another kind. A file compressed by gzip is judged by its content.
std::optional<Error> find_foreign(const std::filesystem::path& path);

}  // namespace slammot::files
