#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/mcap/records.hpp"

namespace slammot::mcap {

/// Collects the records of one chunk and the index of its messages. It keeps its memory when
/// cleared, so that filling it again allocates nothing in steady state.
class ChunkBuilder {
 public:
  void add(const Schema& schema);
  void add(const Channel& channel);
  /// Its channel must have been added to this chunk or to an earlier one of the file.
  void add(const MessageHead& head, Bytes data);
  void clear();

  Bytes records() const { return records_; }
  bool empty() const { return records_.empty(); }
  std::uint64_t message_count() const { return message_count_; }
  std::int64_t start_ns() const { return start_ns_; }
  std::int64_t end_ns() const { return end_ns_; }
  /// Of the channels with messages, in the order of their first ones.
  std::span<const MessageIndex> indexes() const { return {indexes_.data(), index_count_}; }
  const std::vector<Schema>& schemas() const { return schemas_; }
  const std::vector<Channel>& channels() const { return channels_; }

 private:
  MessageIndex& index_of(ChannelId channel_id);

  Buffer records_;
  std::vector<MessageIndex> indexes_;   ///< The first index_count_ are in use.
  std::vector<std::uint32_t> slot_of_;  ///< Place in indexes_ plus one, by channel; 0: none.
  std::size_t index_count_ = 0;
  std::uint64_t message_count_ = 0;
  std::int64_t start_ns_ = 0;
  std::int64_t end_ns_ = 0;
  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
};

}  // namespace slammot::mcap
