#include "services/gateway/hub.hpp"

#include <utility>

#include "services/gateway/protocol.hpp"

namespace slammot::gateway {
namespace {

std::size_t index_of(ChannelId channel) { return static_cast<std::size_t>(channel); }

Retention retention_of(ChannelId channel) { return channels()[index_of(channel)].retention; }

}  // namespace

Hub::Hub(AccessRules access, const SendQueue::Limits& limits, std::string session)
    : access_(std::move(access)), limits_(limits) {
  for (std::string& text : std::vector{server_info("slammot", session), advertisement(channels()),
                                       services_advertisement()})
    greeting_.push_back(std::make_shared<const std::string>(std::move(text)));
}

void Hub::put(const std::string& path, Content content) {
  contents_[path] = std::make_shared<const Content>(std::move(content));
}

std::shared_ptr<const Content> Hub::content(const std::string& path) const {
  const auto found = contents_.find(path);
  return found == contents_.end() ? nullptr : found->second;
}

void Hub::call(ViewerCall call) const {
  if (take_call_) take_call_(std::move(call));
  else call.answer("this server takes no calls");
}

void Hub::count_subscribers(ChannelId channel, int change) {
  subscribers_[index_of(channel)] += change;
}

void Hub::publish(const Message& message) {
  if (retention_of(message.channel) != Retention::kNone) last_[index_of(message.channel)] = message;
  for (Viewer* viewer : std::set<Viewer*>(viewers_)) {
    if (viewers_.contains(viewer)) viewer->deliver(message);
  }
}

std::optional<Message> Hub::last(ChannelId channel) const { return last_[index_of(channel)]; }

bool Hub::is_wanted(ChannelId channel) const {
  return retention_of(channel) == Retention::kLast || subscribers_[index_of(channel)] > 0;
}

HubCounters Hub::counters() const {
  return {counts.connections,      counts.viewers,          counts.refused_connections,
          counts.refused_messages, counts.dropped_messages, counts.sent_messages,
          counts.sent_bytes};
}

}  // namespace slammot::gateway
