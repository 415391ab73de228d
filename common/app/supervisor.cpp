#include "common/app/supervisor.hpp"

#include <systemd/sd-daemon.h>

namespace slammot::app {
namespace {

/// A notice has one field a line.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n') c = ' ';
  }
  return text;
}

}  // namespace

void tell_supervisor(wire::ServiceState state, const std::string& explanation) {
  std::string notice = state == wire::ServiceState::kStopping ? "STOPPING=1\n" : "READY=1\n";
  notice += "STATUS=" + std::string(wire::to_string(state));
  if (!explanation.empty()) notice += ": " + one_line(explanation);
  sd_notify(0, notice.c_str());
}

void tell_supervisor_alive() { sd_notify(0, "WATCHDOG=1"); }

}  // namespace slammot::app
