#pragma once

#include <span>
#include <string_view>

namespace slammot::gateway {

struct EmbeddedFile {
  std::string_view name;
  std::string_view bytes;
};

/// The files of page/, written by cmake/embed_files.cmake when the program is built.
std::span<const EmbeddedFile> embedded_page();

}  // namespace slammot::gateway
