#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "common/dds/reader.hpp"

namespace slammot::dds {

/// Sleeps until one of its readers has samples, and then calls what handles them: in the waiting
/// thread, never in one of the bus. The loop of a service is
///     while (wait_set.wait(100ms) != Wake::kStopped) { ...what time demands... }
class WaitSet {
 public:
  enum class Wake { kHandled, kTimedOut, kStopped };

  explicit WaitSet(const Participant& participant);

  /// `handler` must take from the reader, or the next wait returns at once. Handlers are called in
  /// the order in which they were added here. The reader must outlive this wait set's last wait.
  void on_data(const ReaderBase& reader, std::function<void()> handler);

  /// Handles what has come, or waits for it. Once stopped, only returns kStopped. Throws what a
  /// handler throws.
  Wake wait(std::chrono::nanoseconds timeout);

  /// From now on wait() lets so much time pass after samples have come before it handles them:
  /// those that come soon after are handled with them.
  void gather_for(std::chrono::nanoseconds duration) { gathering_ = duration; }

  /// Makes the wait under way and all later ones return kStopped. From any thread, but not from a
  /// signal handler.
  void stop();

 private:
  struct Attached {
    Entity::Handle condition;
    std::function<void()> handler;
  };

  Entity wait_set_;
  Entity stop_;
  std::vector<Attached> attached_;
  std::chrono::nanoseconds gathering_{0};
};

}  // namespace slammot::dds
