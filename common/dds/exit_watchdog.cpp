#include "common/dds/exit_watchdog.hpp"

#include <cstdlib>
#include <iostream>

namespace slammot::dds {

void ExitWatchdog::arm() {
  if (!thread_.joinable()) thread_ = std::thread([this] { watch(); });
}

void ExitWatchdog::watch() {
  std::unique_lock lock(mutex_);
  if (left_in_time_.wait_for(lock, patience_, [this] { return disarmed_; })) return;
  std::cerr << "leaving the DDS bus took longer than " << patience_.count() << " ms: giving up\n";
  std::_Exit(kExitCode);
}

ExitWatchdog::~ExitWatchdog() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    disarmed_ = true;
  }
  left_in_time_.notify_one();
  thread_.join();
}

}  // namespace slammot::dds
