#include "services/slammot/side_thread.hpp"

#include <chrono>
#include <utility>

namespace slammot {
namespace {

using Clock = std::chrono::steady_clock;

/// Waking a thread often costs more than the work passed to it. Work arrives scan by scan: the
/// thread spins for longer than the pauses within a scan.
constexpr std::chrono::microseconds kSpinTime(250);
constexpr int kSpinsPerClockReading = 64;

void pause_briefly() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// True unless spinning would delay the thread that is waited for.
bool may_spin() {
  static const bool has = std::thread::hardware_concurrency() != 1;  // 0: unknown
  return has;
}

/// Waits until the state differs from `than`: spins for a while, then sleeps.
void await_change(const std::atomic<std::uint32_t>& state, std::uint32_t than) {
  const Clock::time_point until = Clock::now() + kSpinTime;
  while (may_spin() && Clock::now() < until) {
    for (int spin = 0; spin < kSpinsPerClockReading; ++spin, pause_briefly())
      if (state.load(std::memory_order_acquire) != than) return;
  }
  state.wait(than, std::memory_order_acquire);
}

}  // namespace

SideThread::SideThread() {
  for (Number i = 0; i < kPlaces; ++i) places_[i].state = state_of(i - kPlaces, kDone);
  shared_.state = state_of(Number{0} - 1, kDone);
  thread_ = std::jthread([this] { work_until_stopped(); });
}

SideThread::~SideThread() {
  wait();
  begin([this] {
    is_stopping_ = true;
    return false;
  });
}

void SideThread::put(Place& place, Number number, std::function<bool()> step) {
  place.step = std::move(step);
  place.state.store(state_of(number, kBegun), std::memory_order_release);
}

void SideThread::wake() {
  wakes_.fetch_add(1, std::memory_order_release);
  wakes_.notify_one();
}

void SideThread::begin(std::function<bool()> step) {
  const Number number = begun_.load(std::memory_order_relaxed);
  while (number - ended_ >= kPlaces) complete_oldest();
  put(place_of(number), number, std::move(step));
  begun_.store(number + 1, std::memory_order_release);
  wake();
}

void SideThread::wait() {
  while (ended_ != begun_.load(std::memory_order_relaxed)) complete_oldest();
}

/// Completes the oldest work that the caller has not awaited.
void SideThread::complete_oldest() {
  Place& place = place_of(ended_);
  if (!try_work(place, ended_, false)) await_completion(place, ended_);
  ++ended_;
}

void SideThread::share(std::size_t parts, const std::function<void(std::size_t)>& part) {
  std::atomic<std::size_t> next{0};
  const auto take_parts = [&] {
    for (std::size_t i = next.fetch_add(1, std::memory_order_relaxed); i < parts;
         i = next.fetch_add(1, std::memory_order_relaxed))
      part(i);
    return false;
  };
  if (may_spin()) {
    const Number number = shares_.load(std::memory_order_relaxed);
    put(shared_, number, std::cref(take_parts));
    shares_.store(number + 1, std::memory_order_release);
    wake();
    take_parts();
    if (!withdraw(shared_, number)) await_completion(shared_, number);
  } else {
    take_parts();
  }
}

/// Does the work unless somebody else has taken it; returns false in that case. With
/// `joins_shared`, does shared parts between steps.
bool SideThread::try_work(Place& place, Number number, bool joins_shared) {
  std::uint32_t begun = state_of(number, kBegun);
  if (!place.state.compare_exchange_strong(begun, state_of(number, kTaken),
                                           std::memory_order_acquire))
    return false;
  while (place.step())
    if (joins_shared) do_shared();
  place.state.store(state_of(number, kDone), std::memory_order_release);
  place.state.notify_one();
  return true;
}

/// Removes work that nobody has taken. Returns true if there was such work.
bool SideThread::withdraw(Place& place, Number number) {
  std::uint32_t begun = state_of(number, kBegun);
  return place.state.compare_exchange_strong(begun, state_of(number, kDone),
                                             std::memory_order_relaxed);
}

/// The place may hold a later work, with another number, by the time that this returns.
void SideThread::await_completion(Place& place, Number number) {
  while (place.state.load(std::memory_order_acquire) == state_of(number, kTaken))
    await_change(place.state, state_of(number, kTaken));
}

/// Does parts that are shared at present, if any.
void SideThread::do_shared() {
  const Number shares = shares_.load(std::memory_order_acquire);
  try_work(shared_, shares - 1, false);
}

/// Works strictly in order: work that the caller has taken must end before the next begins.
void SideThread::work_until_stopped() {
  for (Number number = 0; !is_stopping_;) {
    const std::uint32_t wakes = wakes_.load(std::memory_order_acquire);
    do_shared();
    if (begun_.load(std::memory_order_acquire) == number) {
      await_change(wakes_, wakes);
      continue;
    }
    if (!try_work(place_of(number), number, true)) await_completion(place_of(number), number);
    ++number;
  }
}

}  // namespace slammot
