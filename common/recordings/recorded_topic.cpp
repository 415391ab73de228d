#include "common/recordings/recorded_topic.hpp"

#include <algorithm>
#include <map>

#include "common/dds/cdr_walk.hpp"
#include "common/dds/idl_text.hpp"
#include "common/files/base64.hpp"
#include "common/mcap/message_cursor.hpp"

namespace slammot::recordings {
namespace {

constexpr const char* kInformation = "dds.type_information";
constexpr const char* kMapping = "dds.type_mapping";
constexpr const char* kIdl = "omgidl";
constexpr const char* kCdr = "cdr";
/// The vehicle's id is among the first bytes of a sample; the rest need not be read for it.
constexpr std::size_t kHeadBytes = 64;

std::vector<std::uint8_t> bytes_in(const mcap::Channel& channel, const char* key) {
  const auto text = channel.metadata.find(key);
  if (text == channel.metadata.end()) return {};
  return files::from_base64(text->second).value_or(std::vector<std::uint8_t>());
}

}  // namespace

RecordedTopic describe(const dds::RawTopic& topic, const dds::OfferedQos& qos) {
  RecordedTopic recorded;
  const std::string idl = dds::idl_text(topic.model());
  recorded.schema.name = topic.type().name;
  recorded.schema.encoding = kIdl;
  recorded.schema.data.assign(idl.begin(), idl.end());
  recorded.channel.topic = topic.info().name;
  recorded.channel.message_encoding = kCdr;
  recorded.channel.metadata = dds::texts_of(qos);
  recorded.channel.metadata[kInformation] = files::to_base64(topic.type().information);
  recorded.channel.metadata[kMapping] = files::to_base64(topic.type().mapping);
  return recorded;
}

std::optional<PlayableTopic> playable(const mcap::Contents& contents,
                                      const mcap::Channel& channel) {
  const auto schema = contents.schemas.find(channel.schema_id);
  if (schema == contents.schemas.end() || channel.message_encoding != kCdr) return std::nullopt;
  auto topic = dds::RawTopic::of_type(
      channel.topic,
      {schema->second.name, bytes_in(channel, kInformation), bytes_in(channel, kMapping)});
  if (!topic) return std::nullopt;
  return PlayableTopic{std::move(topic), dds::offered_qos_of(channel.metadata)};
}

std::string vehicle_of(const dds::TypeModel& model, std::span<const std::uint8_t> cdr) {
  std::string vehicle_id;
  const auto head = cdr.first(std::min(cdr.size(), kHeadBytes));
  dds::for_each_value(model, head, [&](const dds::CdrValue& value) {
    if (value.path == "vehicle_id") vehicle_id = value.text;
  });
  return vehicle_id;
}

std::string first_vehicle(const mcap::File& file) {
  std::map<mcap::ChannelId, std::shared_ptr<const dds::RawTopic>> topics;
  for (const auto& [id, channel] : file.contents().channels) {
    if (channel.topic == dds::topics::kHeartbeat.name || channel.topic == dds::topics::kStatus.name)
      continue;
    if (auto topic = playable(file.contents(), channel)) topics[id] = std::move(topic->topic);
  }
  mcap::MessageCursor cursor(file, {});
  while (const auto message = cursor.next()) {
    const auto topic = topics.find(message->head.channel_id);
    if (topic == topics.end()) continue;
    if (std::string vehicle = vehicle_of(topic->second->model(), message->data); !vehicle.empty())
      return vehicle;
  }
  return {};
}

}  // namespace slammot::recordings
