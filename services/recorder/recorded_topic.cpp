#include "services/recorder/recorded_topic.hpp"

#include "common/dds/idl_text.hpp"
#include "common/files/base64.hpp"

namespace slammot::recorder {
namespace {

constexpr const char* kInformation = "dds.type_information";
constexpr const char* kMapping = "dds.type_mapping";
constexpr const char* kIdl = "omgidl";
constexpr const char* kCdr = "cdr";

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

std::optional<PlayableTopic> playable(const mcap::Channel& channel, const mcap::Schema* schema) {
  if (schema == nullptr || channel.message_encoding != kCdr) return std::nullopt;
  auto topic = dds::RawTopic::of_type(
      channel.topic, {schema->name, bytes_in(channel, kInformation), bytes_in(channel, kMapping)});
  if (!topic) return std::nullopt;
  return PlayableTopic{std::move(topic), dds::offered_qos_of(channel.metadata)};
}

}  // namespace slammot::recorder
