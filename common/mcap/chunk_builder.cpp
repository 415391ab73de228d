#include "common/mcap/chunk_builder.hpp"

#include <algorithm>

namespace slammot::mcap {

void ChunkBuilder::add(const Schema& schema) {
  append(schema, records_);
  schemas_.push_back(schema);
}

void ChunkBuilder::add(const Channel& channel) {
  append(channel, records_);
  channels_.push_back(channel);
}

void ChunkBuilder::add(const MessageHead& head, Bytes data) {
  index_of(head.channel_id).entries.push_back({head.log_time_ns, records_.size()});
  append(head, data, records_);
  start_ns_ = message_count_ == 0 ? head.log_time_ns : std::min(start_ns_, head.log_time_ns);
  end_ns_ = message_count_ == 0 ? head.log_time_ns : std::max(end_ns_, head.log_time_ns);
  ++message_count_;
}

MessageIndex& ChunkBuilder::index_of(ChannelId channel_id) {
  if (slot_of_.size() <= channel_id) slot_of_.resize(channel_id + std::size_t{1});
  std::uint32_t& slot = slot_of_[channel_id];
  if (slot == 0) {
    if (index_count_ == indexes_.size()) indexes_.emplace_back();
    indexes_[index_count_].channel_id = channel_id;
    slot = static_cast<std::uint32_t>(++index_count_);
  }
  return indexes_[slot - 1];
}

void ChunkBuilder::clear() {
  records_.clear();
  for (std::size_t i = 0; i < index_count_; ++i) {
    slot_of_[indexes_[i].channel_id] = 0;
    indexes_[i].entries.clear();
  }
  index_count_ = 0;
  message_count_ = 0;
  start_ns_ = 0;
  end_ns_ = 0;
  schemas_.clear();
  channels_.clear();
}

}  // namespace slammot::mcap
