#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace slammot::wire {

/// Collects what was sent in parts, in any order: by its sequence number, until all parts have
/// come. `Shared`, which every part repeats, must be comparable: a part that differs is of a sender
/// that restarted and counts from the beginning, and replaces what came before it.
template <typename Shared, typename Item>
class PartCollector {
 public:
  struct Complete {
    Shared shared;
    std::vector<Item> items;  ///< Of all parts, in their order.
  };

  /// All of it if this was the last missing part. index is below count; a part that comes twice
  /// counts as it came last.
  std::optional<Complete> add(std::uint32_t sequence, std::size_t index, std::size_t count,
                              const Shared& shared, std::vector<Item> items) {
    Partial& partial = partial_of(sequence, count, shared);
    partial.parts[index] = std::move(items);
    const auto has_come = [](const auto& part) { return part.has_value(); };
    if (!std::ranges::all_of(partial.parts, has_come)) return std::nullopt;
    Complete complete{partial.shared, {}};
    for (auto& part : partial.parts)
      complete.items.insert(complete.items.end(), std::make_move_iterator(part->begin()),
                            std::make_move_iterator(part->end()));
    partial_.erase(sequence);
    return complete;
  }

 private:
  static constexpr std::size_t kMostIncomplete = 4;  // one that newer ones overtook never completes

  struct Partial {
    Shared shared;
    std::vector<std::optional<std::vector<Item>>> parts;
  };

  Partial& partial_of(std::uint32_t sequence, std::size_t count, const Shared& shared) {
    const auto known = partial_.find(sequence);
    if (known != partial_.end()) {
      if (known->second.parts.size() == count && known->second.shared == shared)
        return known->second;
      partial_.erase(known);
    }
    if (partial_.size() == kMostIncomplete) partial_.erase(partial_.begin());
    Partial& begun = partial_[sequence];
    begun = {shared, std::vector<std::optional<std::vector<Item>>>(count)};
    return begun;
  }

  std::map<std::uint32_t, Partial> partial_;  ///< By sequence number.
};

}  // namespace slammot::wire
