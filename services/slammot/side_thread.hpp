#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>

#include "common/work/side_work.hpp"

namespace slammot {

/// Work in a separate thread beside the caller's. On waiting, the caller does work that the thread
/// has not begun, for example for want of a core: using the thread never costs more than it saves.
/// All functions must be called from one thread.
class SideThread : public work::SideWork {
 public:
  SideThread();
  ~SideThread() override;
  SideThread(const SideThread&) = delete;
  SideThread& operator=(const SideThread&) = delete;

  void begin(std::function<bool()> step) override;
  void wait() override;

  /// The thread joins after its current step, if parts are left by then.
  void share(std::size_t parts, const std::function<void(std::size_t)>& part) override;

 private:
  /// Works are numbered in order, modulo a power of two; no two pending works have equal numbers.
  using Number = std::uint32_t;
  enum Stage : std::uint32_t { kBegun, kTaken, kDone, kStages };
  struct Place {
    std::atomic<std::uint32_t> state{0};  ///< Of the work in this place: its number * kStages + its
                                          ///< stage.
    std::function<bool()> step;  ///< Owned by whoever has moved the state from kBegun to kTaken.
  };
  static constexpr Number kPlaces = 16;

  static constexpr std::uint32_t state_of(Number number, Stage stage) {
    return number * kStages + stage;
  }
  Place& place_of(Number number) { return places_[number % kPlaces]; }
  static void put(Place& place, Number number, std::function<bool()> step);
  static bool withdraw(Place& place, Number number);
  static void await_completion(Place& place, Number number);
  bool try_work(Place& place, Number number, bool joins_shared);
  void complete_oldest();
  void do_shared();
  void wake();
  void work_until_stopped();

  std::array<Place, kPlaces> places_;  ///< Begun works, by number.
  Place shared_;                       ///< The shared work, with its own numbers.
  std::atomic<Number> begun_{0};
  std::atomic<Number> shares_{0};
  std::atomic<std::uint32_t> wakes_{0};  ///< Changes when there is work for the thread.
  Number ended_ = 0;                     ///< Number of works that the caller has awaited.
  bool is_stopping_ = false;             ///< Accessed by the thread only.
  std::jthread thread_;                  ///< Last member: must end before the others are destroyed.
};

}  // namespace slammot
