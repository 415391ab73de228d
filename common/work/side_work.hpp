#pragma once

#include <cstddef>
#include <functional>

namespace slammot::work {

/// Somewhere that work can go on beside the caller's. Estimators know no threads; whoever composes them may have one to lend.
class SideWork {
 public:
  virtual ~SideWork() = default;

  /// Lets step() be done again and again until it returns false, by the return of wait() at the latest. What was begun before is
  /// done first; what is shared comes between two steps.
  virtual void begin(std::function<bool()> step) = 0;

  /// Returns when all that was begun is done, and seen by the caller.
  virtual void wait() = 0;

  /// Does part(0) to part(parts - 1), each once, in any order and perhaps side by side; returns when all are done, and seen by
  /// the caller. What was begun before may go on beyond that: no part may rely on it.
  virtual void share(std::size_t parts, const std::function<void(std::size_t)>& part) = 0;
};

/// Does part(i) for each i < parts, by turns with the help if there is any (null: none). Whatever one part writes, no other may
/// touch: then the result does not depend on who did it.
template <typename Part>
void share(SideWork* help, std::size_t parts, const Part& part) {
  if (help != nullptr && parts > 1) return help->share(parts, std::cref(part));  // a reference: no allocation
  for (std::size_t i = 0; i < parts; ++i) part(i);
}

/// Does work(first, end) for so many ranges that are all of [0, count), as share() does its parts.
template <typename Work>
void share_in_ranges(SideWork* help, std::size_t count, std::size_t ranges, const Work& work) {
  if (help == nullptr || count < ranges) return work(std::size_t{0}, count);
  share(help, ranges, [&](std::size_t i) { work(count * i / ranges, count * (i + 1) / ranges); });
}

}  // namespace slammot::work
