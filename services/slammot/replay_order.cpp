#include "services/slammot/replay_order.hpp"

#include <utility>

namespace slammot {

bool ReplayOrder::needs_more() const {
  return !is_at_end_ &&
         (held_.empty() || held_.begin()->first > newest_log_time_ns_ - kLongestHoldUpNs);
}

std::optional<mcap::Message> ReplayOrder::next() {
  while (needs_more()) {
    const auto message = cursor_.next();
    is_at_end_ = !message;
    if (!message) break;
    newest_log_time_ns_ = message->head.log_time_ns;
    held_.emplace(message->head.publish_time_ns,
                  Held{*message, {message->data.begin(), message->data.end()}});
  }
  if (held_.empty()) return std::nullopt;
  present_ = std::move(held_.extract(held_.begin()).mapped());
  present_.message.data = present_.data;
  return present_.message;
}

}  // namespace slammot
