#pragma once

#include <string>

#include "common/wire/service.hpp"

namespace slammot::app {

/// Tells the supervisor that started this process where it stands: systemd, for a unit of
/// Type=notify. Without one these do nothing.
/// Any state but "stopping" means that the unit has started; `explanation` is shown by `systemctl
/// status`.
void tell_supervisor(wire::ServiceState state, const std::string& explanation);

/// Sign of life for the unit's watchdog.
void tell_supervisor_alive();

}  // namespace slammot::app
