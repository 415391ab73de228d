#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::config {

/// Folders that may hold profiles, best first: $SLAMMOT_PROFILES, then share/slammot/profiles of an installation and
/// deploy/profiles of the source tree around the running program.
std::vector<std::filesystem::path> profile_folders();

/// The file of a profile: a path is taken as it is, a name is looked for in the folders. Nothing when there is none.
std::optional<std::filesystem::path> find_profile(const std::string& name_or_path);

/// Names that find_profile() knows, sorted.
std::vector<std::string> profile_names();

/// "unknown profile 'x'; there are: indoor, urban"
std::string unknown_profile(std::string_view name);

}  // namespace slammot::config
