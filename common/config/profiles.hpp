#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::config {

/// Files of one kind that are shipped: NAME.textproto in a folder of their own.
struct Shelf {
  const char* variable;  ///< Of the environment: a folder to look into first.
  const char* folder;    ///< In share/slammot of an installation and in deploy of the source tree around the running program.
};
inline constexpr Shelf kProfiles{"SLAMMOT_PROFILES", "profiles"};
inline constexpr Shelf kScenarios{"SLAMMOT_SCENARIOS", "scenarios"};

/// Folders of a shelf, best first.
std::vector<std::filesystem::path> folders_of(const Shelf& shelf);

/// A path is taken as it is, a name is looked for in the folders. Nothing when there is none.
std::optional<std::filesystem::path> find_file(const Shelf& shelf, const std::string& name_or_path);

/// Names that find_file() knows, sorted.
std::vector<std::string> names_on(const Shelf& shelf);

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
