#include "common/bags/ros1_bag_reader.hpp"

#include <utility>

#include "common/bags/unpack.hpp"

namespace slammot::bags {
namespace {

constexpr std::uint64_t kMaxHeaderBytes = std::uint64_t{1} << 20;

enum Op : std::uint8_t {
  kMessageData = 0x02,
  kBagHeader = 0x03,
  kBagChunk = 0x05,
  kConnection = 0x07
};

/// One field "name=value" of a header; empty where there is none.
std::pair<std::string_view, Bytes> next_field(ByteReader& reader) {
  const Bytes field = reader.take(reader.number<std::uint32_t>());
  const std::string_view text = text_of(field);
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return {};
  return {text.substr(0, equals), field.subspan(equals + 1)};
}

}  // namespace

Ros1BagReader::Ros1BagReader(ByteSource file) : file_(std::move(file)) {
  file_.read(kMagic.size(), data_);
  has_ended_ = text_of(data_) != kMagic;
  if (has_ended_) note("the file does not begin as a bag of version 2.0 does");
}

void Ros1BagReader::note(const std::string& damage) {
  if (damage_.empty()) damage_ = damage;
}

std::optional<Ros1BagReader::Head> Ros1BagReader::head_of(Bytes header) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  Head head;
  ByteReader reader(header);
  while (reader.left() > 0) {
    const auto [name, bytes] = next_field(reader);
    ByteReader value(bytes);
    if (name.empty()) return std::nullopt;
    if (name == "op") head.op = value.number<std::uint8_t>();
    if (name == "conn") head.connection = value.number<std::uint32_t>();
    if (name == "topic") head.topic = text_of(value.rest());
    if (name == "compression") head.compression = text_of(value.rest());
    if (name == "size") head.unpacked_bytes = value.number<std::uint32_t>();
    if (name == "index_pos") head.index_at = value.number<std::uint64_t>();
    if (name == "time") {
      const auto seconds = value.number<std::uint32_t>();
      head.time_ns = kNanosecondsPerSecond * seconds + value.number<std::uint32_t>();
    }
    if (!value.is_ok()) return std::nullopt;
  }
  return reader.is_ok() ? std::optional(head) : std::nullopt;
}

std::optional<Ros1BagReader::Record> Ros1BagReader::record_of(ByteReader& reader) {
  const Bytes header = reader.take(reader.number<std::uint32_t>());
  const Bytes data = reader.take(reader.number<std::uint32_t>());
  const auto head = head_of(header);
  if (!reader.is_ok() || !head) return std::nullopt;
  return Record{*head, data};
}

std::optional<RawMessage> Ros1BagReader::next() {
  while (true) {
    while (chunk_at_ < chunk_.size()) {
      ByteReader reader(Bytes(chunk_).subspan(chunk_at_));
      const auto record = record_of(reader);
      if (!record) {
        note("the chunk before byte " + std::to_string(file_.position()) + " ends in a record");
        chunk_at_ = chunk_.size();
        break;
      }
      chunk_at_ += reader.position();
      if (record->head.op == kConnection) take_connection(*record);
      if (record->head.op != kMessageData) continue;
      if (auto message = message_of(*record)) return message;
    }
    if (has_ended_ || !read_record()) return std::nullopt;
  }
}

/// The next record outside of chunks. False at the end.
bool Ros1BagReader::read_record() {
  record_begins_ = file_.position();
  has_ended_ = true;
  if (index_at_ > 0 && record_begins_ >= index_at_) return false;
  file_.read(sizeof(std::uint32_t), header_);
  const auto header_bytes = ByteReader(header_).number<std::uint32_t>();
  if (header_.size() < sizeof(std::uint32_t)) {
    note(index_at_ == 0 && header_.empty() && !file_.is_damaged()
             ? "the bag was never closed"
             : "the file ends at byte " + std::to_string(file_.position()) + ", before its index");
    return false;
  }
  if (header_bytes > kMaxHeaderBytes)
    return note("no record begins at byte " + std::to_string(record_begins_)), false;
  file_.read(header_bytes, header_);
  const auto head = head_of(header_);
  file_.read(sizeof(std::uint32_t), data_);
  if (header_.size() < header_bytes || data_.size() < sizeof(std::uint32_t))
    return note("the file ends in the record at byte " + std::to_string(record_begins_)), false;
  if (!head) return note("no record begins at byte " + std::to_string(record_begins_)), false;
  const auto data_bytes = ByteReader(data_).number<std::uint32_t>();
  if (head->op == kBagHeader) index_at_ = head->index_at;
  const bool is_of_use = head->op == kBagChunk || head->op == kConnection;
  if (!is_of_use || data_bytes > kMostUnpackedBytes) {
    if (is_of_use)
      note("the record at byte " + std::to_string(record_begins_) + " is said to have " +
           std::to_string(data_bytes) + " bytes");
    has_ended_ = !file_.skip(data_bytes);
    if (has_ended_) note("the file ends in the record at byte " + std::to_string(record_begins_));
    return !has_ended_;
  }
  file_.read(data_bytes, data_);
  const bool is_whole = data_.size() == data_bytes;
  if (!is_whole) note("the file ends in the record at byte " + std::to_string(record_begins_));
  has_ended_ = !is_whole;
  if (head->op == kBagChunk) take_chunk(*head, is_whole);
  else if (is_whole) take_connection({*head, data_});
  return is_whole || chunk_at_ < chunk_.size();
}

void Ros1BagReader::take_chunk(const Head& head, bool is_whole) {
  const std::string where = "the chunk at byte " + std::to_string(record_begins_);
  chunk_.clear();
  chunk_at_ = 0;
  if (!can_unpack(head.compression))
    return note(where + " is packed in a way that is not known here");
  Unpacked unpacked = unpack(head.compression, data_);
  if (is_whole && (!unpacked.is_whole || unpacked.bytes.size() != head.unpacked_bytes))
    note(where + " does not unpack to its end");
  chunk_ = std::move(unpacked.bytes);
}

void Ros1BagReader::take_connection(const Record& record) {
  if (!record.head.connection || channels_.size() >= kMaxChannels ||
      channels_.contains(*record.head.connection))
    return;
  Channel channel;
  channel.topic = record.head.topic;
  channel.serialization = Serialization::kRos1;
  ByteReader reader(record.data);
  while (reader.left() > 0) {
    const auto [name, value] = next_field(reader);
    if (name == "type") channel.type = without_msg(text_of(value));
    if (name == "md5sum") channel.md5 = text_of(value);
  }
  channels_.emplace(*record.head.connection, std::move(channel));
}

std::optional<RawMessage> Ros1BagReader::message_of(const Record& record) const {
  if (!record.head.connection) return std::nullopt;
  const auto channel = channels_.find(*record.head.connection);
  if (channel == channels_.end()) return std::nullopt;
  return RawMessage{&channel->second, record.head.time_ns, record.data};
}

}  // namespace slammot::bags
