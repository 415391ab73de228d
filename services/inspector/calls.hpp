#pragma once

#include <cstdio>
#include <stdexcept>

#include "services/inspector/bus_options.hpp"

namespace slammot::inspector {

/// Result of `work`; a fault of the bus becomes a line and an exit code.
template <typename Work>
int guarded(Work&& work) {
  try {
    return work();
  } catch (const std::runtime_error& fault) {
    std::fprintf(stderr, "slammot: %s\n", fault.what());
    return kExitFault;
  }
}

}  // namespace slammot::inspector
