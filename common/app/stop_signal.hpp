#pragma once

#include <functional>
#include <thread>

namespace slammot::app {

/// While it exists, SIGINT and SIGTERM call `stop` in a separate thread instead of ending the
/// process; a second signal ends it at once. Create it before any other thread, so that all threads
/// block these signals.
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
