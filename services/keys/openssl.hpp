#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/files/result.hpp"

namespace slammot::keys {

/// Runs the command openssl in a folder, without a shell. Returns what it prints, or its last line
/// if it fails.
files::Result<std::string> openssl(const std::filesystem::path& folder,
                                   std::vector<std::string> arguments);

}  // namespace slammot::keys
