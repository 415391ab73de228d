#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/mcap/message_cursor.hpp"

namespace slammot {

/// Messages of a recording by the times at which they were written. A recorder that is held up
/// notes later times, and those of several topics in another order.
class ReplayOrder {
 public:
  ReplayOrder(const mcap::File& file, mcap::Selection selection)
      : cursor_(file, std::move(selection)) {}

  /// Valid until the next call. None at the end.
  std::optional<mcap::Message> next();

 private:
  /// A message that was written so much earlier than another was recorded comes first.
  static constexpr std::int64_t kLongestHoldUpNs = 2'000'000'000;

  struct Held {
    mcap::Message message;
    std::vector<std::uint8_t> data;
  };
  bool needs_more() const;

  mcap::MessageCursor cursor_;
  std::multimap<std::int64_t, Held> held_;  ///< By publish time.
  std::int64_t newest_log_time_ns_ = 0;
  bool is_at_end_ = false;
  Held present_;
};

}  // namespace slammot
