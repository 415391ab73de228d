#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/gateway/access.hpp"
#include "services/gateway/audience.hpp"
#include "services/gateway/calls.hpp"
#include "services/gateway/channels.hpp"
#include "services/gateway/send_queue.hpp"

namespace slammot::gateway {

struct Message {
  ChannelId channel{};
  std::uint64_t time_ns = 0;
  std::shared_ptr<const std::string> payload;
};

/// A connected viewer.
class Viewer {
 public:
  virtual ~Viewer() = default;
  virtual void deliver(const Message& message) = 0;
};

struct HubCounters {
  std::uint64_t connections = 0;  ///< Open now, pages that load included.
  std::uint64_t viewers = 0;      ///< Of these, with a WebSocket.
  std::uint64_t refused_connections = 0;
  std::uint64_t refused_messages = 0;
  std::uint64_t dropped_messages = 0;
  std::uint64_t sent_messages = 0;
  std::uint64_t sent_bytes = 0;
};

/// What all connections of the server share. is_wanted(), counters() and `counts` are for any
/// thread, the rest for the server's.
class Hub {
 public:
  Hub(AccessRules access, const SendQueue::Limits& limits, std::string session);

  const AccessRules& access() const { return access_; }
  const SendQueue::Limits& limits() const { return limits_; }
  /// First messages to a viewer: server info and channels.
  const std::vector<std::shared_ptr<const std::string>>& greeting() const { return greeting_; }

  void put(const std::string& path, Content content);
  void remove(const std::string& path) { contents_.erase(path); }
  /// Null if there is none.
  std::shared_ptr<const Content> content(const std::string& path) const;

  void add(Viewer& viewer) { viewers_.insert(&viewer); }
  void remove(Viewer& viewer) { viewers_.erase(&viewer); }
  void count_subscribers(ChannelId channel, int change);
  void publish(const Message& message);
  /// Last message of a channel that retains it.
  std::optional<Message> last(ChannelId channel) const;

  /// True if anybody subscribes, or may later and expects the last message.
  bool is_wanted(ChannelId channel) const;
  HubCounters counters() const;

  /// What happens to calls of viewers, in the server's thread. Before the first connection.
  void on_call(std::function<void(ViewerCall)> take) { take_call_ = std::move(take); }
  void call(ViewerCall call) const;

  struct Counts {
    std::atomic<std::uint64_t> connections{0}, viewers{0}, refused_connections{0},
        refused_messages{0}, dropped_messages{0}, sent_messages{0}, sent_bytes{0};
  };
  Counts counts;

 private:
  AccessRules access_;
  SendQueue::Limits limits_;
  std::vector<std::shared_ptr<const std::string>> greeting_;
  std::map<std::string, std::shared_ptr<const Content>> contents_;
  std::set<Viewer*> viewers_;
  std::array<std::optional<Message>, kChannelCount> last_;
  std::function<void(ViewerCall)> take_call_;
  std::array<std::atomic<int>, kChannelCount> subscribers_{};
};

}  // namespace slammot::gateway
