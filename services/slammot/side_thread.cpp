#include "services/slammot/side_thread.hpp"

#include <chrono>
#include <utility>

namespace slammot {
namespace {

using Clock = std::chrono::steady_clock;

/// Waking a thread costs both sides more than what is often handed over, and work comes scan by scan: longer than the pauses within one.
constexpr std::chrono::microseconds kLooksFor(250);
constexpr int kLooksBetweenTimes = 64;

void pause_briefly() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Whether looking takes nothing from whoever is to change the state.
bool has_core_of_its_own() {
  static const bool has = std::thread::hardware_concurrency() != 1;  // 0: nobody knows
  return has;
}

/// The state once it is another, without sleeping for as long as that is worth it.
std::uint32_t await_other(const std::atomic<std::uint32_t>& state, std::uint32_t than) {
  const Clock::time_point until = Clock::now() + kLooksFor;
  while (has_core_of_its_own() && Clock::now() < until) {
    for (int look = 0; look < kLooksBetweenTimes; ++look, pause_briefly()) {
      const std::uint32_t now = state.load(std::memory_order_acquire);
      if (now != than) return now;
    }
  }
  state.wait(than, std::memory_order_acquire);
  return state.load(std::memory_order_acquire);
}

}  // namespace

SideThread::SideThread() : thread_([this] { work_until_stopped(); }) {}

SideThread::~SideThread() {
  wait();
  state_.store(kStopping, std::memory_order_release);
  state_.notify_all();
}

void SideThread::begin(std::function<void()> work) {
  wait();
  work_ = std::move(work);
  state_.store(kBegun, std::memory_order_release);
  state_.notify_one();
}

void SideThread::wait() {
  take_and_do();
  while (state_.load(std::memory_order_acquire) == kTaken) await_other(state_, kTaken);
}

bool SideThread::take_and_do() {
  std::uint32_t begun = kBegun;
  if (!state_.compare_exchange_strong(begun, kTaken, std::memory_order_acquire)) return false;
  work_();
  state_.store(kIdle, std::memory_order_release);
  state_.notify_one();
  return true;
}

void SideThread::work_until_stopped() {
  std::uint32_t state = kIdle;
  while (state != kStopping) {
    if (!take_and_do()) state = await_other(state_, state);
    else state = kIdle;
  }
}

}  // namespace slammot
