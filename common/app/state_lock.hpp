#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

namespace slammot::app {

/// Keeps the state of a service for one process: a lock on a file, which the system takes back when
/// the process ends, however it ends.
class StateLock {
 public:
  enum class Outcome {
    kLocked,
    kInUse,   ///< Another process has it.
    kCannot,  ///< The file cannot be made, e.g. for a read-only folder; nobody can write state
              ///< then.
  };

  explicit StateLock(std::filesystem::path path) : path_(std::move(path)) {}
  ~StateLock() { release(); }
  StateLock(const StateLock&) = delete;
  StateLock& operator=(const StateLock&) = delete;

  /// Does not wait. Makes missing folders.
  Outcome try_lock();

  /// Gives the state to the next process.
  void release();

  /// The process that has the lock, by this process's numbering; none if there is none or it is of
  /// another container.
  std::optional<pid_t> holder() const;

  /// Why the last try failed, in one line: it names the process that has the lock.
  const std::string& reason() const { return reason_; }

 private:
  void write_process_number() const;

  std::filesystem::path path_;
  int file_ = -1;
  std::string reason_;
};

}  // namespace slammot::app
