#pragma once

#include <span>

#include "common/files/embedded_file.hpp"

namespace slammot::gateway {

/// The files of page/, written by cmake/embed_files.cmake when the program is built.
std::span<const files::EmbeddedFile> embedded_page();

}  // namespace slammot::gateway
