#pragma once

#include <chrono>
#include <optional>

#include "common/app/input_watch.hpp"

namespace slammot::app {

/// Decides when a reader with a deep history leaves old samples out. After a restart of this
/// service or of one before it, a long queue is worked through in no time; a queue that stays long
/// means that more comes than can be processed.
class QueueWatch {
 public:
  static constexpr std::chrono::seconds kPatience{2};

  /// `is_long`: of the queue from which samples are taken now. True if they are to be left out.
  bool leaves_out(bool is_long, SteadyTime now) {
    if (!is_long) return false;
    if (!last_ || now - *last_ > kPatience) since_ = now;
    last_ = now;
    return now - since_ > kPatience;
  }

 private:
  std::optional<SteadyTime> last_;  ///< The queue was long.
  SteadyTime since_{};
};

}  // namespace slammot::app
