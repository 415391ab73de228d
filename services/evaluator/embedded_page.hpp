#pragma once

#include <span>

#include "common/files/embedded_file.hpp"

namespace slammot::evaluator {

/// The script and styles of a report, written by cmake/embed_files.cmake when the program is built.
std::span<const files::EmbeddedFile> embedded_page();

}  // namespace slammot::evaluator
