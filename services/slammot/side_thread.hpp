#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <thread>

#include "services/localization/side_work.hpp"

namespace slammot {

/// Work beside the caller's on a thread of its own. If the thread has not even begun when its work is waited for, for want of
/// a core, the caller does it instead: help never costs more than it saves. Used from one thread.
class SideThread : public localization::SideWork {
 public:
  SideThread();
  ~SideThread() override;
  SideThread(const SideThread&) = delete;
  SideThread& operator=(const SideThread&) = delete;

  void begin(std::function<void()> work) override;
  void wait() override;

 private:
  enum State : std::uint32_t { kIdle, kBegun, kTaken, kStopping };

  void work_until_stopped();
  bool take_and_do();

  std::function<void()> work_;        ///< Belongs to whoever took state_ from kBegun to kTaken.
  std::atomic<std::uint32_t> state_{kIdle};
  std::jthread thread_;               ///< Last: it must end before the rest goes.
};

}  // namespace slammot
