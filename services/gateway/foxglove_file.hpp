#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "common/mcap/stream_writer.hpp"
#include "services/gateway/audience.hpp"

namespace slammot::gateway {

/// An MCAP file of the messages that viewers would be sent, with their schemas: Foxglove and others
/// open it without knowing this project.
class FoxgloveFile : public Audience {
 public:
  explicit FoxgloveFile(const std::filesystem::path& path);

  /// Log time of the messages to come.
  void set_time(std::int64_t log_time_ns) { log_time_ns_ = log_time_ns; }

  bool is_wanted(ChannelId) const override { return true; }
  void publish(ChannelId channel, std::int64_t time_ns, std::string payload) override;
  void put(const std::string&, Content) override {}  // nobody asks a file for paths
  void remove(const std::string&) override {}

  /// Ends the file.
  bool finish() { return writer_.finish(); }
  std::uint64_t messages() const { return writer_.statistics().message_count; }
  const std::string& fault() const { return writer_.fault(); }

 private:
  struct Place {
    mcap::ChannelId id = 0;
    std::uint32_t next_sequence = 0;
  };

  mcap::StreamWriter writer_;
  std::array<Place, kChannelCount> places_;
  std::int64_t log_time_ns_ = 0;
};

}  // namespace slammot::gateway
