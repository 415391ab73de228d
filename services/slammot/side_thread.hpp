#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>

#include "common/work/side_work.hpp"

namespace slammot {

/// Work beside the caller's on a thread of its own. What the thread has not even begun when it is
/// waited for, for want of a core, the caller does instead: help never costs more than it saves.
/// Used from one thread.
class SideThread : public work::SideWork {
 public:
  SideThread();
  ~SideThread() override;
  SideThread(const SideThread&) = delete;
  SideThread& operator=(const SideThread&) = delete;

  void begin(std::function<bool()> step) override;
  void wait() override;

  /// The thread joins in after the step that it is at, if there are parts left by then.
  void share(std::size_t parts, const std::function<void(std::size_t)>& part) override;

 private:
  /// Works are numbered as they are begun, modulo a power of two that no two at hand differ by.
  using Number = std::uint32_t;
  enum Stage : std::uint32_t { kBegun, kTaken, kDone, kStages };
  struct Place {
    std::atomic<std::uint32_t> state{0};  ///< Of the work that is here now: its number * kStages +
                                          ///< its stage.
    std::function<bool()> step;           ///< Belongs to whoever took the state from kBegun on.
  };
  static constexpr Number kPlaces = 16;

  static constexpr std::uint32_t state_of(Number number, Stage stage) {
    return number * kStages + stage;
  }
  Place& place_of(Number number) { return places_[number % kPlaces]; }
  static void put(Place& place, Number number, std::function<bool()> step);
  static bool withdraw(Place& place, Number number);
  static void await_end_of(Place& place, Number number);
  bool take_and_do(Place& place, Number number, bool joins_in);
  void end_first();
  void join_in();
  void call();
  void work_until_stopped();

  std::array<Place, kPlaces> places_;  ///< What was begun, by its number.
  Place shared_;                       ///< What is shared, numbered by itself.
  std::atomic<Number> begun_{0};
  std::atomic<Number> shares_{0};
  std::atomic<std::uint32_t> calls_{0};  ///< Changes whenever there is something to do for the
                                         ///< thread.
  Number ended_ = 0;                     ///< So many of what was begun the caller knows to be done.
  bool is_stopping_ = false;             ///< The thread's.
  std::jthread thread_;                  ///< Last: it must end before the rest goes.
};

}  // namespace slammot
