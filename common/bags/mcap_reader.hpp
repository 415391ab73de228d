#pragma once

#include <map>
#include <vector>

#include "common/bags/byte_source.hpp"
#include "common/bags/message_source.hpp"

namespace slammot::bags {

/// Reads an MCAP file (mcap.dev/spec, version 0) from its beginning to its end, so that neither an
/// index nor an end is needed: a file that was cut is read as far as it goes. Chunks that do not
/// unpack or fail their checksum are left out.
class McapReader : public MessageSource {
 public:
  explicit McapReader(ByteSource file);

  std::optional<RawMessage> next() override;
  double fraction_read() const override { return file_.fraction_read(); }
  std::string damage() const override { return damage_; }

 private:
  struct Schema {
    std::string name;
  };

  bool read_record();
  void take(std::uint8_t opcode, Bytes content);
  void take_schema(Bytes content);
  void take_channel(Bytes content);
  void take_chunk(Bytes content, bool is_whole);
  std::optional<RawMessage> message_of(Bytes content) const;
  void note(const std::string& damage);

  ByteSource file_;
  std::vector<std::uint8_t> record_;   ///< Outside of chunks.
  std::vector<std::uint8_t> chunk_;    ///< Unpacked,
  std::size_t chunk_at_ = 0;           ///< and read so far.
  std::optional<RawMessage> message_;  ///< Outside of chunks.
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::uint64_t record_begins_ = 0;
  bool has_ended_ = false;
  std::string damage_;
};

}  // namespace slammot::bags
