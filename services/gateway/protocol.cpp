#include "services/gateway/protocol.hpp"

#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>

namespace slammot::gateway {
namespace {

using Json = nlohmann::json;

constexpr std::uint8_t kMessageData = 1;
constexpr std::size_t kMostAtOnce = 256;  ///< In one message.

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<std::uint32_t> number_in(const Json& json) {
  if (!json.is_number_unsigned()) return std::nullopt;
  const auto number = json.get<std::uint64_t>();
  if (number > 0xFFFFFFFFU) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

const Json* list_in(const Json& message, const char* name) {
  const auto found = message.find(name);
  if (found == message.end() || !found->is_array() || found->size() > kMostAtOnce) return nullptr;
  return &*found;
}

std::optional<Subscription> subscription_in(const Json& json) {
  if (!json.is_object() || !json.contains("id") || !json.contains("channelId")) return std::nullopt;
  const auto id = number_in(json["id"]);
  const auto channel = number_in(json["channelId"]);
  if (!id || !channel || *channel >= kChannelCount) return std::nullopt;
  return Subscription{*id, static_cast<ChannelId>(*channel)};
}

ClientMessage parse_subscribe(const Json& message) {
  const Json* list = list_in(message, "subscriptions");
  if (list == nullptr) return Refused{"subscribe without a list of subscriptions"};
  Subscribe subscribe;
  for (const Json& entry : *list) {
    const auto subscription = subscription_in(entry);
    if (!subscription) return Refused{"a subscription to no channel"};
    subscribe.subscriptions.push_back(*subscription);
  }
  return subscribe;
}

ClientMessage parse_unsubscribe(const Json& message) {
  const Json* list = list_in(message, "subscriptionIds");
  if (list == nullptr) return Refused{"unsubscribe without a list of subscriptionIds"};
  Unsubscribe unsubscribe;
  for (const Json& entry : *list) {
    const auto id = number_in(entry);
    if (!id) return Refused{"a subscription id that is no number"};
    unsubscribe.subscriptions.push_back(*id);
  }
  return unsubscribe;
}

template <typename Number>
void write_little_endian(Number number, std::uint8_t* to) {
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    to[i] = static_cast<std::uint8_t>(number >> (8 * i));
}

}  // namespace

std::string_view choose_subprotocol(std::string_view requested) {
  while (!requested.empty()) {
    const std::size_t comma = requested.find(',');
    const std::string_view name = trimmed(requested.substr(0, comma));
    const auto* const known = std::ranges::find(kSubprotocols, name);
    if (known != kSubprotocols.end()) return *known;
    requested = comma == std::string_view::npos ? std::string_view{} : requested.substr(comma + 1);
  }
  return {};
}

std::string server_info(const std::string& name, const std::string& session) {
  const Json info = {{"op", "serverInfo"},           {"name", name},
                     {"capabilities", {"services"}}, {"supportedEncodings", {"json"}},
                     {"metadata", Json::object()},   {"sessionId", session}};
  return info.dump();
}

std::string advertisement(const std::vector<Channel>& channels) {
  Json list = Json::array();
  for (const Channel& channel : channels)
    list.push_back({{"id", static_cast<std::uint32_t>(channel.id)},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding()}});
  return Json{{"op", "advertise"}, {"channels", std::move(list)}}.dump();
}

std::string status_message(Severity severity, const std::string& text) {
  const Json message = {{"op", "status"}, {"level", static_cast<int>(severity)}, {"message", text}};
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

DataHeader data_header(std::uint32_t subscription, std::uint64_t time_ns) {
  DataHeader header{};
  header[0] = kMessageData;
  write_little_endian(subscription, header.data() + 1);
  write_little_endian(time_ns, header.data() + 5);
  return header;
}

ClientMessage parse_client_message(std::string_view text) {
  const Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) return Refused{"not a JSON object"};
  const auto op = message.find("op");
  if (op == message.end() || !op->is_string()) return Refused{"no operation"};
  if (*op == "subscribe") return parse_subscribe(message);
  if (*op == "unsubscribe") return parse_unsubscribe(message);
  return Refused{"this server does not serve the operation"};
}

}  // namespace slammot::gateway
