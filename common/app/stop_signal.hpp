#pragma once

#include <functional>
#include <thread>

namespace slammot::app {

/// While it lives, SIGINT and SIGTERM call `stop` in a thread of its own instead of ending the process; a second one ends
/// it at once. Make it before any other thread, so that all of them leave these signals to it.
class StopSignal {
 public:
  explicit StopSignal(std::function<void()> stop);
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

 private:
  void watch();

  std::function<void()> stop_;
  int signals_;
  int quit_;
  std::thread thread_;
};

}  // namespace slammot::app
