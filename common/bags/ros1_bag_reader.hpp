#pragma once

#include <map>
#include <vector>

#include "common/bags/byte_source.hpp"
#include "common/bags/message_source.hpp"

namespace slammot::bags {

/// Reads a bag of ROS 1, format 2.0 (wiki.ros.org/Bags/Format/2.0), from its beginning to its end,
/// so that no index is needed: a file that was cut, or never closed, is read as far as it goes.
/// Chunks that do not unpack are left out.
class Ros1BagReader : public MessageSource {
 public:
  static constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

  explicit Ros1BagReader(ByteSource file);

  std::optional<RawMessage> next() override;
  double fraction_read() const override { return file_.fraction_read(); }
  std::string damage() const override { return damage_; }

 private:
  /// What a record begins with, as far as it is of use.
  struct Head {
    std::uint8_t op = 0;
    std::optional<std::uint32_t> connection;
    std::int64_t time_ns = 0;
    std::string_view topic;
    std::string_view compression;
    std::uint32_t unpacked_bytes = 0;
    std::uint64_t index_at = 0;
  };
  struct Record {
    Head head;
    Bytes data;
  };

  static std::optional<Head> head_of(Bytes header);
  static std::optional<Record> record_of(ByteReader& reader);
  bool read_record();
  void take_chunk(const Head& head, bool is_whole);
  void take_connection(const Record& record);
  std::optional<RawMessage> message_of(const Record& record) const;
  void note(const std::string& damage);

  ByteSource file_;
  std::vector<std::uint8_t> header_;
  std::vector<std::uint8_t> data_;
  std::vector<std::uint8_t> chunk_;  ///< Unpacked,
  std::size_t chunk_at_ = 0;         ///< and read so far.
  std::map<std::uint32_t, Channel> channels_;
  std::uint64_t index_at_ = 0;  ///< Where the chunks end; 0 in a bag that was never closed.
  std::uint64_t record_begins_ = 0;
  bool has_ended_ = false;
  std::string damage_;
};

}  // namespace slammot::bags
