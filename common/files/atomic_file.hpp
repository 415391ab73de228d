#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "common/files/result.hpp"

namespace slammot::files {

/// Writes the whole file under a temporary name and renames it, so that no reader sees a partial
/// file. On a fault (no space, no permission) the old file, if any, is unchanged.
std::optional<Error> write_file_atomically(const std::filesystem::path& path,
                                           std::string_view content);

/// Creates the folder if it is missing and tests whether a file can be written there, before the
/// work begins.
std::optional<Error> prepare_output_folder(const std::filesystem::path& folder);

/// A message if the folder's file system has less space than is needed [bytes]. Nothing where the
/// space is unknown.
std::optional<Error> find_lack_of_space(const std::filesystem::path& folder, std::uint64_t needed);

}  // namespace slammot::files
