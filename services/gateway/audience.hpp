#pragma once

#include <cstdint>
#include <string>

#include "services/gateway/channels.hpp"

namespace slammot::gateway {

/// What is served under one path.
struct Content {
  std::string type;  ///< Media type.
  std::string body;
  std::string encoding{};  ///< Of the body, "gzip"; empty: as it is.
  unsigned status = 200;
  bool is_public = false;     ///< Holds no data of the vehicle: needs no token.
  bool is_immutable = false;  ///< The path changes with the content.
};

/// For whom messages are made: viewers that are connected, or a file for viewers.
class Audience {
 public:
  virtual ~Audience() = default;

  /// False if a message of the channel would reach nobody.
  virtual bool is_wanted(ChannelId channel) const = 0;
  virtual void publish(ChannelId channel, std::int64_t time_ns, std::string payload) = 0;

  /// Answers requests for `path` with the content, which replaces what was there.
  virtual void put(const std::string& path, Content content) = 0;
  virtual void remove(const std::string& path) = 0;
};

}  // namespace slammot::gateway
