#include "services/slammot/side_thread.hpp"

#include <utility>

namespace slammot {
namespace {

constexpr int kLooksBeforeSleep = 2000;  // tens of microseconds: waking a thread takes as long, and work comes scan by scan

void pause_briefly() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// The state once it is another, without sleeping for as long as that is worth it.
std::uint32_t await_other(const std::atomic<std::uint32_t>& state, std::uint32_t than) {
  for (int look = 0; look < kLooksBeforeSleep; ++look, pause_briefly()) {
    const std::uint32_t now = state.load(std::memory_order_acquire);
    if (now != than) return now;
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
