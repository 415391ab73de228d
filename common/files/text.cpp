#include "common/files/text.hpp"

#include <cstdarg>
#include <cstdio>

namespace slammot::files {

std::string text(const char* format, ...) {
  char line[512];
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  return line;
}

}  // namespace slammot::files
