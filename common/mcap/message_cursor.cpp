#include "common/mcap/message_cursor.hpp"

#include <algorithm>

#include "common/bags/mcap_format.hpp"
#include "common/mcap/scan.hpp"

namespace slammot::mcap {

namespace format = bags::mcap_format;

MessageCursor::MessageCursor(const File& file, Selection selection)
    : file_(file), selection_(std::move(selection)) {
  for (const auto& [id, channel] : file.contents().channels) {
    if (selection_.topics.empty() || selection_.topics.contains(channel.topic))
      channels_.insert(id);
  }
  for (const ChunkIndex& chunk : file.contents().chunks) {
    if (is_of_interest(chunk)) chunks_.push_back(&chunk);
  }
  std::ranges::stable_sort(chunks_, {}, [](const ChunkIndex* chunk) { return chunk->start_ns; });
}

bool MessageCursor::is_of_interest(const ChunkIndex& chunk) const {
  if (chunk.end_ns < selection_.from_ns || chunk.start_ns > selection_.to_ns) return false;
  if (chunk.index_offsets.empty()) return true;
  return std::ranges::any_of(chunk.index_offsets,
                             [&](const auto& index) { return channels_.contains(index.first); });
}

void MessageCursor::open_chunk(const ChunkIndex& index) {
  bags::McapChunk chunk = file_.chunk(index);
  if (!chunk.is_sound) {
    ++left_out_;
    return;
  }
  OpenChunk opened;
  for_each_record(chunk.records, [&](std::uint8_t opcode, Bytes content) {
    const auto head = opcode == format::kMessage ? read_message_head(content) : std::nullopt;
    if (!head) return;
    if (!file_.contents().channels.contains(head->channel_id)) ++left_out_;
    if (!channels_.contains(head->channel_id) || head->log_time_ns < selection_.from_ns ||
        head->log_time_ns > selection_.to_ns)
      return;
    opened.places.push_back(
        {head->log_time_ns, static_cast<std::size_t>(content.data() - chunk.records.data())});
  });
  std::ranges::stable_sort(opened.places, {}, &Place::log_time_ns);
  opened.records = std::move(chunk.records);
  if (!opened.places.empty()) open_.push_back(std::move(opened));
}

/// The open chunk with the earliest message; null without any.
MessageCursor::OpenChunk* MessageCursor::earliest() {
  OpenChunk* first = nullptr;
  for (OpenChunk& chunk : open_) {
    if (chunk.at == chunk.places.size()) continue;
    if (first == nullptr ||
        chunk.places[chunk.at].log_time_ns < first->places[first->at].log_time_ns)
      first = &chunk;
  }
  return first;
}

std::optional<Message> MessageCursor::next() {
  while (!open_.empty() && open_.front().at == open_.front().places.size()) open_.pop_front();
  OpenChunk* first = earliest();
  while (
      next_chunk_ < chunks_.size() &&
      (first == nullptr || chunks_[next_chunk_]->start_ns < first->places[first->at].log_time_ns)) {
    open_chunk(*chunks_[next_chunk_++]);
    first = earliest();
  }
  if (first == nullptr) return std::nullopt;
  return message_at(*first, first->places[first->at++].offset);
}

Message MessageCursor::message_at(const OpenChunk& chunk, std::size_t offset) const {
  const Bytes records = chunk.records;
  bags::ByteReader length(records.subspan(offset - sizeof(std::uint64_t)));
  const Bytes content =
      records.subspan(offset, static_cast<std::size_t>(length.number<std::uint64_t>()));
  const MessageHead head = read_message_head(content).value_or(MessageHead{});
  return {&file_.contents().channels.at(head.channel_id), head,
          content.subspan(format::kMessageHeadBytes)};
}

}  // namespace slammot::mcap
