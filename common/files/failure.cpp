#include "common/files/failure.hpp"

#include <cstdio>

namespace slammot::files {

namespace {

void say_why(std::string_view why) {
  std::fprintf(stderr, "slammot: %.*s\n", static_cast<int>(why.size()), why.data());
}

}  // namespace

int fail(std::string_view why) {
  say_why(why);
  return 1;
}

int refuse(std::string_view why) {
  say_why(why);
  return 2;
}

}  // namespace slammot::files
