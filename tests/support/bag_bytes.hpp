#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

namespace slammot::testing {

/// How the messages of a made bag are written.
enum class Wire : std::uint8_t { kRos1, kCdrLittle, kCdrBig };

/// Puts numbers into bytes as ROS 1 or CDR has them.
class MessageBytes {
 public:
  explicit MessageBytes(Wire wire) : wire_(wire) {
    if (wire != Wire::kRos1)
      bytes_ = wire == Wire::kCdrLittle ? std::string("\0\1\0\0", 4) : std::string("\0\0\0\0", 4);
    begin_ = bytes_.size();
  }

  template <typename Number>
  MessageBytes& add(Number value) {
    while (wire_ != Wire::kRos1 && (bytes_.size() - begin_) % sizeof value != 0) bytes_ += '\0';
    auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
    if (wire_ == Wire::kCdrBig) std::ranges::reverse(raw);
    bytes_.append(raw.data(), raw.size());
    return *this;
  }

  MessageBytes& text(std::string_view text) {
    add(static_cast<std::uint32_t>(text.size() + (wire_ == Wire::kRos1 ? 0 : 1)));
    bytes_ += text;
    if (wire_ != Wire::kRos1) bytes_ += '\0';
    return *this;
  }

  MessageBytes& header(double stamp_s, std::string_view frame) {
    if (wire_ == Wire::kRos1) add(std::uint32_t{7});
    add(static_cast<std::uint32_t>(stamp_s));
    add(static_cast<std::uint32_t>(std::llround((stamp_s - std::floor(stamp_s)) * 1e9)));
    return text(frame);
  }

  MessageBytes& numbers(const std::vector<double>& values) {
    for (const double value : values) add(value);
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  Wire wire_;
  std::string bytes_;
  std::size_t begin_ = 0;
};

struct ScanSpec {
  double stamp_s = 1.0;
  std::string frame = "laser";
  float first_rad = -1.5707964F;
  float step_rad = 1.5707964F;
  float most_range_m = 30.0F;
  std::vector<float> range_m = {1.0F, 2.0F, 3.0F};
};

inline std::string scan_message(Wire wire, const ScanSpec& spec) {
  MessageBytes bytes(wire);
  bytes.header(spec.stamp_s, spec.frame)
      .add(spec.first_rad)
      .add(spec.first_rad + spec.step_rad * static_cast<float>(spec.range_m.size() - 1));
  bytes.add(spec.step_rad)
      .add(0.0F)
      .add(0.1F)
      .add(0.05F)
      .add(spec.most_range_m)
      .add(static_cast<std::uint32_t>(spec.range_m.size()));
  for (const float range_m : spec.range_m) bytes.add(range_m);
  return bytes.add(std::uint32_t{0}).bytes();
}

inline std::string odometry_message(Wire wire, double stamp_s, double x_m, double heading_rad,
                                    std::string_view child = "base_link") {
  MessageBytes bytes(wire);
  bytes.header(stamp_s, "odom")
      .text(child)
      .numbers({x_m, 0.5, 0.0, 0.0, 0.0, std::sin(heading_rad / 2.0), std::cos(heading_rad / 2.0)});
  return bytes.numbers(std::vector<double>(36 + 6 + 36)).bytes();
}

/// Translation and quaternion x, y, z, w.
inline std::string transform_message(Wire wire, double stamp_s, std::string_view parent,
                                     std::string_view child, const std::vector<double>& seven) {
  return MessageBytes(wire)
      .add(std::uint32_t{1})
      .header(stamp_s, parent)
      .text(child)
      .numbers(seven)
      .bytes();
}

struct MessageSpec {
  std::string topic;
  std::string type;  ///< As ROS 1 names it.
  double log_time_s = 0.0;
  std::string bytes;
};

inline std::string packed(std::string_view compression, const std::string& plain) {
  std::string out(plain.size() * 2 + 1024, '\0');
  if (compression == "zstd")
    out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 1));
  else if (compression == "lz4")
    out.resize(LZ4F_compressFrame(out.data(), out.size(), plain.data(), plain.size(), nullptr));
  else if (compression == "bz2") {
    auto size = static_cast<unsigned>(out.size());
    std::string from = plain;
    BZ2_bzBuffToBuffCompress(out.data(), &size, from.data(), static_cast<unsigned>(from.size()), 1,
                             0, 0);
    out.resize(size);
  } else return plain;
  return out;
}

template <typename Number>
std::string raw(Number value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
  return {bytes.data(), bytes.size()};
}

inline std::string sized(std::string_view text) {
  return raw(static_cast<std::uint32_t>(text.size())) + std::string(text);
}
inline std::uint64_t ns_of(double seconds) {
  return static_cast<std::uint64_t>(std::llround(seconds * 1e9));
}

inline std::vector<std::string> topics_of(const std::vector<MessageSpec>& messages) {
  std::vector<std::string> topics;
  for (const MessageSpec& message : messages) {
    if (std::ranges::find(topics, message.topic) == topics.end()) topics.push_back(message.topic);
  }
  return topics;
}

inline const std::string& type_of(const std::vector<MessageSpec>& messages,
                                  const std::string& topic) {
  return std::ranges::find(messages, topic, &MessageSpec::topic)->type;
}

inline std::string mcap_record(std::uint8_t opcode, const std::string& content) {
  return raw(opcode) + raw(static_cast<std::uint64_t>(content.size())) + content;
}

/// An MCAP file without an index. Compression "" or "lz4" or "zstd" of chunks of two messages; "no
/// chunks" for none.
inline std::string mcap_file(const std::vector<MessageSpec>& messages, std::string_view compression,
                             std::string_view encoding = "cdr") {
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string file = magic + mcap_record(0x01, sized("ros2") + sized("test"));
  const auto topics = topics_of(messages);
  for (std::size_t i = 0; i < topics.size(); ++i) {
    std::string type = type_of(messages, topics[i]);
    if (encoding == "cdr") type.replace(type.find('/'), 1, "/msg/");
    const auto id = static_cast<std::uint16_t>(i + 1);
    file += mcap_record(0x03, raw(id) + sized(type) + sized("ros2msg") + sized("definition"));
    file += mcap_record(
        0x04, raw(id) + raw(id) + sized(topics[i]) + sized(encoding) + raw(std::uint32_t{0}));
  }
  std::string chunk;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(std::ranges::find(topics, messages[i].topic) -
                                               topics.begin() + 1);
    const std::string time = raw(ns_of(messages[i].log_time_s));
    chunk += mcap_record(
        0x05, raw(id) + raw(static_cast<std::uint32_t>(i)) + time + time + messages[i].bytes);
    if (i % 2 == 0 && i + 1 < messages.size()) continue;
    const auto crc = static_cast<std::uint32_t>(crc32(
        0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<unsigned>(chunk.size())));
    const std::string small = packed(compression, chunk);
    if (compression == "no chunks") file += chunk;
    else
      file += mcap_record(0x06, raw(std::uint64_t{0}) + raw(std::uint64_t{0}) +
                                    raw(static_cast<std::uint64_t>(chunk.size())) + raw(crc) +
                                    sized(compression) +
                                    raw(static_cast<std::uint64_t>(small.size())) + small);
    chunk.clear();
  }
  return file + mcap_record(0x0F, raw(std::uint32_t{0})) +
         mcap_record(0x02, std::string(20, '\0')) + magic;
}

inline std::string ros1_field(std::string_view name, std::string_view value) {
  return sized(std::string(name) + "=" + std::string(value));
}
inline std::string ros1_record(const std::string& header, const std::string& data) {
  return sized(header) + sized(data);
}

/// A bag of ROS 1, all messages in one chunk, closed as it should be but without its index'
/// content.
inline std::string ros1_file(const std::vector<MessageSpec>& messages,
                             std::string_view compression) {
  const auto topics = topics_of(messages);
  std::string chunk;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const std::string connection = ros1_field("topic", topics[i]) +
                                   ros1_field("type", type_of(messages, topics[i])) +
                                   ros1_field("md5sum", "*") + ros1_field("message_definition", "");
    chunk += ros1_record(ros1_field("op", "\x07") +
                             ros1_field("conn", raw(static_cast<std::uint32_t>(i))) +
                             ros1_field("topic", topics[i]),
                         connection);
  }
  for (const MessageSpec& message : messages) {
    const auto id =
        static_cast<std::uint32_t>(std::ranges::find(topics, message.topic) - topics.begin());
    const std::uint64_t ns = ns_of(message.log_time_s);
    const std::string time = raw(static_cast<std::uint32_t>(ns / 1'000'000'000)) +
                             raw(static_cast<std::uint32_t>(ns % 1'000'000'000));
    chunk += ros1_record(
        ros1_field("op", "\x02") + ros1_field("conn", raw(id)) + ros1_field("time", time),
        message.bytes);
  }
  const std::string chunk_record =
      ros1_record(ros1_field("op", "\x05") + ros1_field("compression", compression) +
                      ros1_field("size", raw(static_cast<std::uint32_t>(chunk.size()))),
                  packed(compression, chunk));
  const auto bag_header = [&](std::uint64_t index_at) {
    const std::string header = ros1_field("op", "\x03") + ros1_field("index_pos", raw(index_at)) +
                               ros1_field("conn_count", raw(std::uint32_t{0})) +
                               ros1_field("chunk_count", raw(std::uint32_t{1}));
    return std::string("#ROSBAG V2.0\n") + ros1_record(header, std::string(100, ' '));
  };
  return bag_header(bag_header(0).size() + chunk_record.size()) + chunk_record;
}

/// A database of rosbag2.
inline void write_db3(const std::string& path, const std::vector<MessageSpec>& messages) {
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  sqlite3_exec(database,
               "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, "
               "serialization_format TEXT, offered_qos_profiles TEXT);"
               "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
               "data BLOB);",
               nullptr, nullptr, nullptr);
  const auto topics = topics_of(messages);
  for (std::size_t i = 0; i < topics.size(); ++i) {
    std::string type = type_of(messages, topics[i]);
    type.replace(type.find('/'), 1, "/msg/");
    const std::string insert = "INSERT INTO topics VALUES(" + std::to_string(i + 1) + ",'" +
                               topics[i] + "','" + type + "','cdr','')";
    sqlite3_exec(database, insert.c_str(), nullptr, nullptr, nullptr);
  }
  for (const MessageSpec& message : messages) {
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                       -1, &insert, nullptr);
    sqlite3_bind_int64(insert, 1, std::ranges::find(topics, message.topic) - topics.begin() + 1);
    sqlite3_bind_int64(insert, 2, static_cast<sqlite3_int64>(ns_of(message.log_time_s)));
    sqlite3_bind_blob(insert, 3, message.bytes.data(), static_cast<int>(message.bytes.size()),
                      SQLITE_TRANSIENT);
    sqlite3_step(insert);
    sqlite3_finalize(insert);
  }
  sqlite3_close(database);
}

/// A vehicle that goes along x at 1 m/s with a scan every tenth of a second; its laser is 0.3 m
/// ahead of base_link.
inline std::vector<MessageSpec> straight_bag(Wire wire, int scans) {
  std::vector<MessageSpec> messages = {
      {"/tf_static", "tf2_msgs/TFMessage", 100.0,
       transform_message(wire, 100.0, "base_link", "laser", {0.3, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0})}};
  for (int i = 0; i < scans; ++i) {
    const double stamp_s = 100.0 + i / 10.0;
    messages.push_back(
        {"/odom", "nav_msgs/Odometry", stamp_s, odometry_message(wire, stamp_s, i / 10.0, 0.25)});
    messages.push_back(
        {"/scan", "sensor_msgs/LaserScan", stamp_s, scan_message(wire, {.stamp_s = stamp_s})});
  }
  return messages;
}

}  // namespace slammot::testing
