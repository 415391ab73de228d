#include "services/gateway/send_queue.hpp"

#include <algorithm>

namespace slammot::gateway {

SendQueue::Pushed SendQueue::push(Outgoing message) {
  const bool is_data = message.header.has_value();
  if (!is_data && messages_.size() - data_messages_ >= limits_.most_control_messages)
    return Pushed::kGaveUp;
  if (is_data) {
    bytes_ += message.size();
    ++data_messages_;
  }
  messages_.push_back(std::move(message));
  while (data_messages_ > limits_.most_messages ||
         (data_messages_ > 1 && bytes_ > limits_.most_bytes))
    drop_oldest_data();
  return Pushed::kKept;
}

Outgoing SendQueue::pop() {
  Outgoing message = std::move(messages_.front());
  messages_.pop_front();
  if (message.header) {
    bytes_ -= message.size();
    --data_messages_;
  }
  return message;
}

void SendQueue::drop_oldest_data() {
  const auto oldest = std::ranges::find_if(
      messages_, [](const Outgoing& message) { return message.header.has_value(); });
  bytes_ -= oldest->size();
  --data_messages_;
  ++dropped_;
  messages_.erase(oldest);
}

}  // namespace slammot::gateway
