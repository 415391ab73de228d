#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "common/bags/byte_reader.hpp"

namespace slammot::bags {

/// How the bytes of a message are to be understood.
enum class Serialization : std::uint8_t { kRos1, kCdr, kOther };

inline constexpr std::size_t kMaxChannels = 65'536;  ///< Of one bag; what it has beyond is left
                                                     ///< out.

/// One topic as one writer has it.
struct Channel {
  std::string topic;
  std::string type;  ///< "sensor_msgs/LaserScan", for ROS 1 and 2 alike.
  std::string md5;   ///< Of the definition, where the bag names it (ROS 1).
  Serialization serialization = Serialization::kOther;
};

/// One message as it was recorded. Valid until the next one is read.
struct RawMessage {
  const Channel* channel = nullptr;
  std::int64_t log_time_ns = 0;  ///< When it was recorded.
  Bytes bytes;
};

/// The messages of a bag, in the order of the file.
class MessageSource {
 public:
  virtual ~MessageSource() = default;

  /// nullopt at the end of what can be read.
  virtual std::optional<RawMessage> next() = 0;

  /// Share of the file taken in so far, [0, 1].
  virtual double fraction_read() const = 0;

  /// What is damaged and where; empty for a bag that is whole as far as it was read. Parts that are
  /// damaged are left out.
  virtual std::string damage() const = 0;
};

/// "sensor_msgs/msg/LaserScan" of ROS 2 as ROS 1 names it.
inline std::string without_msg(std::string_view type) {
  std::string plain(type);
  const std::size_t at = plain.find("/msg/");
  if (at != std::string::npos) plain.erase(at, 4);
  return plain;
}

}  // namespace slammot::bags
