#pragma once

#include <string_view>

namespace slammot::files {

/// A file that cmake/embed_files.cmake has put into the program.
struct EmbeddedFile {
  std::string_view name;
  std::string_view bytes;
};

}  // namespace slammot::files
