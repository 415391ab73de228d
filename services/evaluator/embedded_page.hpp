#pragma once

#include <span>
#include <string_view>

namespace slammot::evaluator {

struct EmbeddedFile {
  std::string_view name;
  std::string_view bytes;
};

/// The script and styles of a report, written by cmake/embed_files.cmake when the program is built.
std::span<const EmbeddedFile> embedded_page();

}  // namespace slammot::evaluator
