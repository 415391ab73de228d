#include "services/recorder/live_services.hpp"

#include <algorithm>

#include "common/dds/topic_table.hpp"

namespace slammot::recorder {
namespace {

bool is_source_of(std::string_view service, const dds::TopicInfo& topic) {
  return topic.publishers != "*" && topic.flow != dds::Flow::kCommand &&
         dds::may_publish(service, topic);
}

}  // namespace

std::set<std::string> contested_topics(std::string_view service,
                                       const std::set<std::string>& played) {
  std::set<std::string> contested;
  const auto is_contested = [&](const dds::TopicInfo* topic) {
    return is_source_of(service, *topic);
  };
  if (std::ranges::none_of(dds::topic_table(), is_contested)) return contested;
  for (const dds::TopicInfo* topic : dds::topic_table()) {
    const std::string name(topic->name);
    if (played.contains(name) && (is_contested(topic) || name == dds::topics::kHeartbeat.name))
      contested.insert(name);
  }
  return contested;
}

std::string contest(std::string_view service, const std::string& vehicle_id,
                    const std::set<std::string>& topics) {
  std::string names;
  for (const std::string& topic : topics) names += (names.empty() ? "" : ", ") + topic;
  return std::string(service) + " of vehicle " + vehicle_id + " runs on this bus and publishes " +
         names + ", too: stop it, leave them out by --topics, or play on another --domain or --bus";
}

}  // namespace slammot::recorder
