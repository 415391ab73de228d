#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace slammot::dds {

/// Ends the process if leaving it takes too long: deleting a participant can hang, e.g. when its
/// interface is down. Declared before the participant and armed when the work is done; taken back
/// when destroyed, after the participant.
///     ExitWatchdog watchdog;
///     Participant participant(options);
///     ...
///     watchdog.arm();
class ExitWatchdog {
 public:
  static constexpr int kExitCode = 70;  ///< EX_SOFTWARE of sysexits.h

  explicit ExitWatchdog(std::chrono::milliseconds patience = std::chrono::milliseconds(2000))
      : patience_(patience) {}
  ~ExitWatchdog();
  ExitWatchdog(const ExitWatchdog&) = delete;
  ExitWatchdog& operator=(const ExitWatchdog&) = delete;

  /// Starts the time limit `patience` for reaching the destructor; after it, one line on stderr and
  /// exit code kExitCode.
  void arm();

 private:
  void watch();

  std::chrono::milliseconds patience_;
  std::mutex mutex_;
  std::condition_variable left_in_time_;
  bool disarmed_ = false;
  std::thread thread_;
};

}  // namespace slammot::dds
