#include "services/slammot/side_thread.hpp"

#include <chrono>
#include <utility>

namespace slammot {
namespace {

using Clock = std::chrono::steady_clock;

/// Waking a thread costs both sides more than what is often handed over, and work comes scan by
/// scan: longer than the pauses within one.
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

/// Until it is another, without sleeping for as long as that is worth it.
void await_other(const std::atomic<std::uint32_t>& state, std::uint32_t than) {
  const Clock::time_point until = Clock::now() + kLooksFor;
  while (has_core_of_its_own() && Clock::now() < until) {
    for (int look = 0; look < kLooksBetweenTimes; ++look, pause_briefly())
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

void SideThread::call() {
  calls_.fetch_add(1, std::memory_order_release);
  calls_.notify_one();
}

void SideThread::begin(std::function<bool()> step) {
  const Number number = begun_.load(std::memory_order_relaxed);
  while (number - ended_ >= kPlaces) end_first();
  put(place_of(number), number, std::move(step));
  begun_.store(number + 1, std::memory_order_release);
  call();
}

void SideThread::wait() {
  while (ended_ != begun_.load(std::memory_order_relaxed)) end_first();
}

/// Of what the caller does not know to be done.
void SideThread::end_first() {
  Place& place = place_of(ended_);
  if (!take_and_do(place, ended_, false)) await_end_of(place, ended_);
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
  if (has_core_of_its_own()) {
    const Number number = shares_.load(std::memory_order_relaxed);
    put(shared_, number, std::cref(take_parts));
    shares_.store(number + 1, std::memory_order_release);
    call();
    take_parts();
    if (!withdraw(shared_, number)) await_end_of(shared_, number);
  } else {
    take_parts();
  }
}

/// False if somebody else has taken the work, or had. Whoever joins in does what is shared between
/// two steps.
bool SideThread::take_and_do(Place& place, Number number, bool joins_in) {
  std::uint32_t begun = state_of(number, kBegun);
  if (!place.state.compare_exchange_strong(begun, state_of(number, kTaken),
                                           std::memory_order_acquire))
    return false;
  while (place.step())
    if (joins_in) join_in();
  place.state.store(state_of(number, kDone), std::memory_order_release);
  place.state.notify_one();
  return true;
}

/// Whether nobody has taken the work, and now nobody will.
bool SideThread::withdraw(Place& place, Number number) {
  std::uint32_t begun = state_of(number, kBegun);
  return place.state.compare_exchange_strong(begun, state_of(number, kDone),
                                             std::memory_order_relaxed);
}

/// The place may have gone to another work meanwhile, with another number.
void SideThread::await_end_of(Place& place, Number number) {
  while (place.state.load(std::memory_order_acquire) == state_of(number, kTaken))
    await_other(place.state, state_of(number, kTaken));
}

/// Does what it can of what is shared just now, if anything.
void SideThread::join_in() {
  const Number shares = shares_.load(std::memory_order_acquire);
  take_and_do(shared_, shares - 1, false);
}

/// One thing that was begun after the other: what the caller has taken, too, must have ended before
/// the next begins.
void SideThread::work_until_stopped() {
  for (Number number = 0; !is_stopping_;) {
    const std::uint32_t calls = calls_.load(std::memory_order_acquire);
    join_in();
    if (begun_.load(std::memory_order_acquire) == number) {
      await_other(calls_, calls);
      continue;
    }
    if (!take_and_do(place_of(number), number, true)) await_end_of(place_of(number), number);
    ++number;
  }
}

}  // namespace slammot
