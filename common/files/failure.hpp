#pragma once

#include <string_view>

#include "common/files/result.hpp"

namespace slammot::files {

/// Says on stderr why a command ends without what was asked for. Returns its exit code, 1.
int fail(std::string_view why);

/// Says on stderr what is wrong in the command line. Returns its exit code, 2.
int refuse(std::string_view why);

inline int fail(const Error& error) { return fail(error.message); }

}  // namespace slammot::files
