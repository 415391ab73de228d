#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "services/gateway/hub.hpp"

namespace slammot::gateway {

struct PageFile {
  std::string path;  ///< As requested, "/index.html".
  Content content;
};

/// The built-in page, compiled into this program.
std::vector<PageFile> built_in_page();

/// The files of a folder in its place, while the page is being developed.
std::vector<PageFile> page_in(const std::filesystem::path& folder);

}  // namespace slammot::gateway
