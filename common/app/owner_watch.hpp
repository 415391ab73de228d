#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>

#include "common/app/input_watch.hpp"
#include "common/flow/arrival_period.hpp"

namespace slammot::app {

/// Of several writers of one key, keeps to the one that goes on. Another one is accepted when it is
/// gone, or silent for a while: then it was restarted, or replaced by a standby. The rule is that
/// of DDS's exclusive ownership of writers of one strength, but the one that was first keeps the
/// key instead of the one with the lower identifier.
class OwnerWatch {
 public:
  /// Silence after which a key changes hands, or three of its periods if that is longer.
  static constexpr std::chrono::milliseconds kSilence{150};

  struct Source {
    std::uint64_t key = 0;
    std::uint64_t writer = 0;
  };

  /// True if the sample of this source is to be used. `is_gone(writer)`: the writer no longer
  /// exists.
  bool accepts(const Source& source, SteadyTime now,
               const std::function<bool(std::uint64_t writer)>& is_gone);

  /// The key has no writer any more: it is the next one's.
  void release(std::uint64_t key) { owners_.erase(key); }

 private:
  static constexpr std::size_t kMostKeys = 1000;
  struct Owner {
    std::uint64_t writer = 0;
    SteadyTime last;
    flow::ArrivalPeriod period;
  };

  void forget_oldest();

  std::map<std::uint64_t, Owner> owners_;
};

}  // namespace slammot::app
