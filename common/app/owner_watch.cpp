#include "common/app/owner_watch.hpp"

#include <algorithm>

namespace slammot::app {

bool OwnerWatch::accepts(const Source& source, SteadyTime now,
                         const std::function<bool(std::uint64_t writer)>& is_gone) {
  constexpr std::chrono::nanoseconds kLongestPeriod = std::chrono::seconds(1);
  const auto [found, is_new] = owners_.try_emplace(source.key, Owner{source.writer, now, {}});
  Owner& owner = found->second;
  if (owner.writer != source.writer) {
    const auto patience = std::max<std::chrono::nanoseconds>(kSilence, 3 * owner.period);
    if (now - owner.last < patience && !is_gone(owner.writer)) return false;
    owner = {source.writer, now, owner.period};
    return true;
  }
  if (is_new) {
    forget_oldest();
    return true;
  }
  const auto period = std::min<std::chrono::nanoseconds>(now - owner.last, kLongestPeriod);
  owner.period = owner.period.count() == 0 ? period : owner.period + (period - owner.period) / 8;
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
