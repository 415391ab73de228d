#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "services/gateway/hub.hpp"

namespace slammot::gateway {

struct WebServerSettings {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8765;  ///< 0: any free one.
  AccessRules access;
  SendQueue::Limits limits;
  std::uint64_t most_connections = 64;
  std::function<void(ViewerCall)> on_call = {};  ///< In the server's thread; empty: refused.
};

/// HTTP and WebSocket on one port, in a thread of its own. No member function waits for a client.
class WebServer : public Audience {
 public:
  /// Throws std::runtime_error with one line if the port cannot be opened.
  explicit WebServer(const WebServerSettings& settings);
  ~WebServer() override;
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  std::uint16_t port() const;

  bool is_wanted(ChannelId channel) const override;
  void publish(ChannelId channel, std::int64_t time_ns, std::string payload) override;
  void put(const std::string& path, Content content) override;
  void remove(const std::string& path) override;

  HubCounters counters() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace slammot::gateway
