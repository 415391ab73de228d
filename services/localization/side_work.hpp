#pragma once

#include <functional>

namespace slammot::localization {

/// Somewhere that work can go on beside the caller's. Estimators know no threads; whoever composes them may have one to lend.
class SideWork {
 public:
  virtual ~SideWork() = default;

  /// Lets the work be done, by the return of wait() at the latest. What was begun before is done first.
  virtual void begin(std::function<void()> work) = 0;

  /// Returns when all that was begun is done, and seen by the caller.
  virtual void wait() = 0;
};

}  // namespace slammot::localization
