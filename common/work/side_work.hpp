#pragma once

#include <cstddef>
#include <functional>

namespace slammot::work {

/// Interface to a helper thread. Estimators do not create threads; their owner may pass one.
class SideWork {
 public:
  virtual ~SideWork() = default;

  /// Starts calls of step() until it returns false, at the latest by the return of wait(). Earlier
  /// started work comes first; share() is served between two steps.
  virtual void begin(std::function<bool()> step) = 0;

  /// Returns when all started work is done and visible to the caller.
  virtual void wait() = 0;

  /// Runs part(0) to part(parts - 1), each once, in any order, possibly concurrently. Returns when
  /// all are done and visible to the caller. Work started earlier may still run; no part may depend
  /// on it.
  virtual void share(std::size_t parts, const std::function<void(std::size_t)>& part) = 0;
};

/// Runs part(i) for each i < parts, shared with the helper if there is one (may be null). Parts
/// must not write common data, so that the result does not depend on the schedule.
template <typename Part>
void share(SideWork* help, std::size_t parts, const Part& part) {
  if (help != nullptr && parts > 1)
    return help->share(parts, std::cref(part));  // a reference: no allocation
  for (std::size_t i = 0; i < parts; ++i) part(i);
}

/// Runs work(first, end) on ranges that partition [0, count), as share() runs its parts.
template <typename Work>
void share_in_ranges(SideWork* help, std::size_t count, std::size_t ranges, const Work& work) {
  if (help == nullptr || count < ranges) return work(std::size_t{0}, count);
  share(help, ranges, [&](std::size_t i) { work(count * i / ranges, count * (i + 1) / ranges); });
}

}  // namespace slammot::work
