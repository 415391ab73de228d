#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::config {

/// A kind of shipped files: NAME.textproto in a folder.
struct Shelf {
  const char* variable;  ///< Environment variable with a folder that is searched first.
  const char* folder;    ///< In share/slammot of an installation and in deploy of the source tree
                         ///< around the running program.
};
inline constexpr Shelf kProfiles{"SLAMMOT_PROFILES", "profiles"};
inline constexpr Shelf kScenarios{"SLAMMOT_SCENARIOS", "scenarios"};

/// Folders of a shelf, best first.
std::vector<std::filesystem::path> folders_of(const Shelf& shelf);

/// A path is used as it is; a name is searched for in the folders. None if there is no such file.
std::optional<std::filesystem::path> find_file(const Shelf& shelf, const std::string& name_or_path);

/// Names known to find_file(), sorted.
std::vector<std::string> names_on(const Shelf& shelf);

/// "there are: indoor, urban", or which folders hold none and how to name another.
std::string names_or_folders(const Shelf& shelf);

/// Folders that may hold profiles, best first: $SLAMMOT_PROFILES, then share/slammot/profiles of an
/// installation and deploy/profiles of the source tree around the running program.
std::vector<std::filesystem::path> profile_folders();

/// File of a profile: a path is used as it is; a name is searched for in the folders. None if there
/// is no such file.
std::optional<std::filesystem::path> find_profile(const std::string& name_or_path);

/// Names known to find_profile(), sorted.
std::vector<std::string> profile_names();

/// "unknown profile 'x'; there are: indoor, urban"
std::string unknown_profile(std::string_view name);

}  // namespace slammot::config
