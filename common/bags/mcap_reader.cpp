#include "common/bags/mcap_reader.hpp"

#include <algorithm>
#include <utility>

#include "common/bags/mcap_chunk.hpp"
#include "common/bags/mcap_format.hpp"
#include "common/bags/unpack.hpp"

namespace slammot::bags {
namespace {

using namespace mcap_format;

bool is_of_use(std::uint8_t opcode) {
  return opcode == kSchema || opcode == kChannel || opcode == kMessage || opcode == kChunk;
}

}  // namespace

McapReader::McapReader(ByteSource file) : file_(std::move(file)) {
  file_.read(kMagic.size(), record_);
  has_ended_ = text_of(record_) != kMagic;
  if (has_ended_) note("the file does not begin as an MCAP file does");
}

void McapReader::note(const std::string& damage) {
  if (damage_.empty()) damage_ = damage;
}

std::optional<RawMessage> McapReader::next() {
  while (true) {
    if (auto message = std::exchange(message_, std::nullopt)) return message;
    while (chunk_at_ < chunk_.size()) {
      ByteReader reader(Bytes(chunk_).subspan(chunk_at_));
      const auto opcode = reader.number<std::uint8_t>();
      const Bytes content = reader.take(reader.number<std::uint64_t>());
      if (!reader.is_ok()) {
        note("the chunk before byte " + std::to_string(file_.position()) + " ends in a record");
        chunk_at_ = chunk_.size();
        break;
      }
      chunk_at_ += reader.position();
      if (opcode == kChunk) continue;  // there are none within chunks
      take(opcode, content);
      if (auto message = std::exchange(message_, std::nullopt)) return message;
    }
    if (has_ended_ || !read_record()) return std::nullopt;
  }
}

/// The next record outside of chunks. False at the end.
bool McapReader::read_record() {
  record_begins_ = file_.position();
  file_.read(kRecordHeadBytes, record_);
  ByteReader head(record_);
  const auto opcode = head.number<std::uint8_t>();
  const auto length = head.number<std::uint64_t>();
  has_ended_ = true;
  if (!head.is_ok() || file_.is_damaged())
    return note("the file ends at byte " + std::to_string(file_.position()) +
                ", before its end is said"),
           false;
  if (opcode == kDataEnd || opcode == kFooter) return false;
  if (!is_opcode(opcode))
    return note("no record begins at byte " + std::to_string(record_begins_)), false;
  if (!is_of_use(opcode) || length > kMostUnpackedBytes) {
    if (is_of_use(opcode))
      note("the record at byte " + std::to_string(record_begins_) + " is said to have " +
           std::to_string(length) + " bytes");
    has_ended_ = !file_.skip(length);
    if (has_ended_) note("the file ends in the record at byte " + std::to_string(record_begins_));
    return !has_ended_;
  }
  file_.read(length, record_);
  const bool is_whole = record_.size() == length;
  if (!is_whole) note("the file ends in the record at byte " + std::to_string(record_begins_));
  has_ended_ = !is_whole;
  if (opcode == kChunk) take_chunk(record_, is_whole);
  else if (is_whole) take(opcode, record_);
  return is_whole || chunk_at_ < chunk_.size();
}

void McapReader::take(std::uint8_t opcode, Bytes content) {
  if (opcode == kSchema) take_schema(content);
  if (opcode == kChannel) take_channel(content);
  if (opcode == kMessage) message_ = message_of(content);
}

void McapReader::take_schema(Bytes content) {
  ByteReader reader(content);
  const auto id = reader.number<std::uint16_t>();
  const std::string_view name = reader.text();
  if (reader.is_ok() && schemas_.size() < kMaxChannels) schemas_[id] = {without_msg(name)};
}

void McapReader::take_channel(Bytes content) {
  ByteReader reader(content);
  const auto id = reader.number<std::uint16_t>();
  const auto schema = schemas_.find(reader.number<std::uint16_t>());
  const std::string_view topic = reader.text();
  const std::string_view encoding = reader.text();
  if (!reader.is_ok() || channels_.contains(id))
    return;  // channels never change, and messages point to them
  Channel channel;
  channel.topic = topic;
  channel.type = schema == schemas_.end() ? std::string() : schema->second.name;
  channel.serialization = encoding == "cdr"    ? Serialization::kCdr
                          : encoding == "ros1" ? Serialization::kRos1
                                               : Serialization::kOther;
  channels_.emplace(id, std::move(channel));
}

void McapReader::take_chunk(Bytes content, bool is_whole) {
  McapChunk chunk = unpack_mcap_chunk(content, is_whole ? McapContent::kWhole : McapContent::kCut);
  if (!chunk.fault.empty())
    note("the chunk at byte " + std::to_string(record_begins_) + " " + chunk.fault);
  chunk_ = std::move(chunk.records);
  chunk_at_ = 0;
}

std::optional<RawMessage> McapReader::message_of(Bytes content) const {
  ByteReader reader(content);
  const auto channel = channels_.find(reader.number<std::uint16_t>());
  reader.number<std::uint32_t>();  // sequence
  const auto log_time_ns = static_cast<std::int64_t>(reader.number<std::uint64_t>());
  reader.number<std::uint64_t>();  // time of publication
  if (!reader.is_ok() || channel == channels_.end()) return std::nullopt;
  return RawMessage{&channel->second, log_time_ns, reader.rest()};
}

}  // namespace slammot::bags
