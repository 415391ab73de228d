#include "common/config/profiles.hpp"

#include <cstdlib>
#include <set>

namespace slammot::config {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kExtension = ".textproto";

fs::path folder_of_this_program() {
  std::error_code unreadable;
  return fs::read_symlink("/proc/self/exe", unreadable).parent_path();
}

}  // namespace

std::vector<fs::path> folders_of(const Shelf& shelf) {
  std::vector<fs::path> folders;
  if (const char* set_by_user = std::getenv(shelf.variable)) folders.emplace_back(set_by_user);
  const fs::path bin = folder_of_this_program();
  folders.push_back(bin.parent_path() / "share/slammot" / shelf.folder);
  for (fs::path above = bin; above.has_relative_path(); above = above.parent_path()) {
    folders.push_back(above / "deploy" / shelf.folder);
  }
  return folders;
}

std::optional<fs::path> find_file(const Shelf& shelf, const std::string& name_or_path) {
  std::error_code not_there;
  const bool is_path =
      name_or_path.find('/') != std::string::npos || name_or_path.ends_with(kExtension);
  if (is_path)
    return fs::is_regular_file(name_or_path, not_there) ? std::optional<fs::path>(name_or_path)
                                                        : std::nullopt;
  for (const fs::path& folder : folders_of(shelf)) {
    const fs::path file = folder / (name_or_path + std::string(kExtension));
    if (fs::is_regular_file(file, not_there)) return file;
  }
  return std::nullopt;
}

std::vector<std::string> names_on(const Shelf& shelf) {
  std::set<std::string> names;
  for (const fs::path& folder : folders_of(shelf)) {
    std::error_code not_there;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, not_there)) {
      if (entry.path().extension() == kExtension) names.insert(entry.path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

std::vector<fs::path> profile_folders() { return folders_of(kProfiles); }

std::optional<fs::path> find_profile(const std::string& name_or_path) {
  return find_file(kProfiles, name_or_path);
}

std::vector<std::string> profile_names() { return names_on(kProfiles); }

std::string names_or_folders(const Shelf& shelf) {
  const auto joined = [](const auto& items, const auto& text_of) {
    std::string text;
    for (const auto& item : items) text += (text.empty() ? "" : ", ") + text_of(item);
    return text;
  };
  const auto itself = [](const std::string& name) { return name; };
  const std::string names = joined(names_on(shelf), itself);
  if (!names.empty()) return "there are: " + names;
  return "there are none in " +
         joined(folders_of(shelf), [](const fs::path& folder) { return folder.string(); }) + "; " +
         shelf.variable + " names their folder";
}

std::string unknown_profile(std::string_view name) {
  return "unknown profile '" + std::string(name) + "'; " + names_or_folders(kProfiles);
}

}  // namespace slammot::config
