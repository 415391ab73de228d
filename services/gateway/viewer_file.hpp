#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/mcap/stream_writer.hpp"
#include "common/sensing/scan.hpp"
#include "services/gateway/audience.hpp"

namespace slammot::gateway {

/// How messages for viewers are written into a file.
class MessageFormat {
 public:
  struct Topic {
    ChannelId source{};
    std::string name;
    mcap::Schema schema;
    std::string encoding;  ///< Of the messages.
  };

  virtual ~MessageFormat() = default;
  virtual std::string profile() const = 0;
  virtual std::vector<Topic> topics() const = 0;
  /// Before the scans of this scanner, as messages for viewers do not have all of it.
  virtual void know(const sensing::Scanner&) {}
  /// A message of one of the topics, from the one for viewers; nullopt if that is malformed.
  virtual std::optional<std::string> encoded(ChannelId source, std::string payload) const = 0;
};

/// As viewers are sent them, with their schemas: Foxglove and others open the file without knowing
/// this project.
std::unique_ptr<MessageFormat> foxglove_format();

/// An MCAP file of the messages that viewers would be sent.
class ViewerFile : public Audience {
 public:
  ViewerFile(const std::filesystem::path& path, const MessageFormat& format);

  /// Log time of the messages to come.
  void set_time(std::int64_t log_time_ns) { log_time_ns_ = log_time_ns; }

  bool is_wanted(ChannelId channel) const override { return place_of(channel).id != 0; }
  void publish(ChannelId channel, std::int64_t time_ns, std::string payload) override;
  void put(const std::string&, Content) override {}  // nobody asks a file for paths
  void remove(const std::string&) override {}

  /// Ends the file.
  bool finish() { return writer_.finish(); }
  std::uint64_t messages() const { return writer_.statistics().message_count; }
  const std::string& fault() const { return writer_.fault(); }

 private:
  struct Place {
    mcap::ChannelId id = 0;  ///< 0: the format has no such topic.
    std::uint32_t next_sequence = 0;
  };

  const Place& place_of(ChannelId channel) const {
    return places_[static_cast<std::size_t>(channel)];
  }

  const MessageFormat& format_;
  mcap::StreamWriter writer_;
  std::array<Place, kChannelCount> places_;
  std::int64_t log_time_ns_ = 0;
};

}  // namespace slammot::gateway
