#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "services/gateway/protocol.hpp"

namespace slammot::gateway {

/// A message for one client. Data messages share their payload with the other clients.
struct Outgoing {
  std::optional<DataHeader> header;  ///< Of a data message.
  std::shared_ptr<const std::string> payload;
  bool is_binary = false;  ///< Without header.

  std::size_t size() const { return payload->size() + (header ? header->size() : 0); }
};

/// Messages that wait until a client takes them. Beyond its limits the oldest data message is
/// dropped: a viewer wants the newest. A client that lets control messages pile up is given up.
class SendQueue {
 public:
  struct Limits {
    std::size_t most_bytes = std::size_t{8} << 20;  ///< Of data messages.
    std::size_t most_messages = 1024;               ///< Of data messages.
    std::size_t most_control_messages = 64;
  };

  explicit SendQueue(const Limits& limits) : limits_(limits) {}

  enum class Pushed { kKept, kGaveUp };
  Pushed push(Outgoing message);

  bool empty() const { return messages_.empty(); }
  Outgoing pop();

  std::uint64_t dropped() const { return dropped_; }
  std::size_t bytes() const { return bytes_; }

 private:
  void drop_oldest_data();

  Limits limits_;
  std::deque<Outgoing> messages_;
  std::size_t bytes_ = 0;          ///< Of waiting data messages.
  std::size_t data_messages_ = 0;  ///< Waiting.
  std::uint64_t dropped_ = 0;
};

}  // namespace slammot::gateway
