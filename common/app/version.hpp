#pragma once

#include <string_view>

namespace slammot::app {

/// Of the whole project, as its CMakeLists.txt says it.
extern const std::string_view kVersion;

}  // namespace slammot::app
