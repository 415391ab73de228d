#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "common/files/result.hpp"

namespace slammot::files {

/// Writes the whole file under a temporary name and renames it, so that nobody ever sees half of it.
/// On a fault (no room, no permission) the old file, if any, is as it was.
std::optional<Error> write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// Makes the folder where it is missing and tries whether a file can be written there: better known before the work
/// than after.
std::optional<Error> prepare_output_folder(const std::filesystem::path& folder);

}  // namespace slammot::files
