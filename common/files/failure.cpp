#include "common/files/failure.hpp"

#include <cstdio>

namespace slammot::files {

int fail(std::string_view why) {
  std::fprintf(stderr, "slammot: %.*s\n", static_cast<int>(why.size()), why.data());
  return 1;
}

}  // namespace slammot::files
