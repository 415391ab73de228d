#include "services/gateway/viewer_file.hpp"

#include <utility>

#include "common/app/version.hpp"
#include "common/files/base64.hpp"

namespace slammot::gateway {
namespace {

class FoxgloveFormat : public MessageFormat {
 public:
  std::string profile() const override { return ""; }

  std::vector<Topic> topics() const override {
    std::vector<Topic> topics;
    for (const Channel& channel : channels())
      topics.push_back({channel.id,
                        channel.topic,
                        {0, channel.schema_name, channel.schema_encoding(), schema_of(channel)},
                        channel.encoding});
    return topics;
  }

  std::optional<std::string> encoded(ChannelId, std::string payload) const override {
    return payload;
  }

 private:
  static std::vector<std::uint8_t> schema_of(const Channel& channel) {
    if (channel.encoding == "protobuf")
      return files::from_base64(channel.schema).value_or(std::vector<std::uint8_t>());
    return {channel.schema.begin(), channel.schema.end()};
  }
};

}  // namespace

std::unique_ptr<MessageFormat> foxglove_format() { return std::make_unique<FoxgloveFormat>(); }

ViewerFile::ViewerFile(const std::filesystem::path& path, const MessageFormat& format)
    : format_(format),
      writer_(path, {format.profile(), "slammot " + std::string(app::kVersion)},
              mcap::Compression::kZstd) {
  for (MessageFormat::Topic& topic : format.topics()) {
    const mcap::SchemaId schema = writer_.add(std::move(topic.schema));
    places_[static_cast<std::size_t>(topic.source)].id =
        writer_.add(mcap::Channel{0, schema, topic.name, topic.encoding, {}});
  }
}

void ViewerFile::publish(ChannelId channel, std::int64_t time_ns, std::string payload) {
  Place& place = places_[static_cast<std::size_t>(channel)];
  if (place.id == 0) return;
  const auto message = format_.encoded(channel, std::move(payload));
  if (message)
    writer_.add({place.id, place.next_sequence++, log_time_ns_, time_ns},
                {reinterpret_cast<const std::uint8_t*>(message->data()), message->size()});
}

}  // namespace slammot::gateway
