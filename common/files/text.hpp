#pragma once

#include <string>

namespace slammot::files {

/// Formats as printf does, in at most 511 bytes; longer text is cut.
[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

}  // namespace slammot::files
