#include "common/app/owner_watch.hpp"

#include <algorithm>

namespace slammot::app {

bool OwnerWatch::accepts(const Source& source, SteadyTime now,
                         const std::function<bool(std::uint64_t writer)>& is_gone) {
  const auto [found, is_new] = owners_.try_emplace(source.key, Owner{source.writer, now, {}});
  Owner& owner = found->second;
  if (owner.writer != source.writer) {
    const std::chrono::nanoseconds patience{
        owner.period.end_after_ns(std::chrono::nanoseconds(kSilence).count())};
    if (now - owner.last < patience && !is_gone(owner.writer)) return false;
    owner = {source.writer, now, owner.period};
    return true;
  }
  if (is_new) {
    forget_oldest();
    return true;
  }
  owner.period.add(std::chrono::nanoseconds(now - owner.last).count());
  owner.last = now;
  return true;
}

/// A writer that makes up keys does not fill the memory.
void OwnerWatch::forget_oldest() {
  if (owners_.size() <= kMostKeys) return;
  owners_.erase(
      std::ranges::min_element(owners_, {}, [](const auto& one) { return one.second.last; }));
}

}  // namespace slammot::app
