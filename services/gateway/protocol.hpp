#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "services/gateway/channels.hpp"

/// Messages of the Foxglove WebSocket protocol, version 1
/// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md).
namespace slammot::gateway {

/// Sub-protocols that the server speaks, the preferred one first.
inline constexpr std::array<std::string_view, 2> kSubprotocols = {"foxglove.sdk.v1",
                                                                  "foxglove.websocket.v1"};

/// The sub-protocol to answer with, of those in the client's header; empty if there is none.
std::string_view choose_subprotocol(std::string_view requested);

/// First message to a client. session: changes with each start of the server.
std::string server_info(const std::string& name, const std::string& session);

std::string advertisement(const std::vector<Channel>& channels);

enum class Severity : std::uint8_t { kInfo = 0, kWarning = 1, kError = 2 };
std::string status_message(Severity severity, const std::string& text);

/// Opcode, subscription and time [ns] that precede the payload of a message.
using DataHeader = std::array<std::uint8_t, 13>;
DataHeader data_header(std::uint32_t subscription, std::uint64_t time_ns);

struct Subscription {
  std::uint32_t id = 0;  ///< Chosen by the client.
  ChannelId channel{};
};
struct Subscribe {
  std::vector<Subscription> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> subscriptions;
};
/// A message that the server does not serve, or that is malformed.
struct Refused {
  std::string reason;
};
using ClientMessage = std::variant<Subscribe, Unsubscribe, Refused>;

/// Any bytes may come. Subscriptions to channels that do not exist are refused as a whole.
ClientMessage parse_client_message(std::string_view text);

}  // namespace slammot::gateway
