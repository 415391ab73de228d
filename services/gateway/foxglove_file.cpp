#include "services/gateway/foxglove_file.hpp"

#include "common/app/version.hpp"
#include "common/files/base64.hpp"

namespace slammot::gateway {
namespace {

std::vector<std::uint8_t> bytes_of(const Channel& channel) {
  if (channel.encoding == "protobuf")
    return files::from_base64(channel.schema).value_or(std::vector<std::uint8_t>());
  return {channel.schema.begin(), channel.schema.end()};
}

mcap::Bytes bytes_of(const std::string& payload) {
  return {reinterpret_cast<const std::uint8_t*>(payload.data()), payload.size()};
}

}  // namespace

FoxgloveFile::FoxgloveFile(const std::filesystem::path& path)
    : writer_(path, {"", "slammot " + std::string(app::kVersion)}, mcap::Compression::kZstd) {
  for (std::size_t i = 0; i < kChannelCount; ++i) {
    const Channel& channel = channels()[i];
    const mcap::SchemaId schema = writer_.add(
        mcap::Schema{0, channel.schema_name, channel.schema_encoding(), bytes_of(channel)});
    places_[i].id = writer_.add(mcap::Channel{0, schema, channel.topic, channel.encoding, {}});
  }
}

void FoxgloveFile::publish(ChannelId channel, std::int64_t time_ns, std::string payload) {
  Place& place = places_[static_cast<std::size_t>(channel)];
  writer_.add({place.id, place.next_sequence++, log_time_ns_, time_ns}, bytes_of(payload));
}

}  // namespace slammot::gateway
