#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/mcap/file.hpp"

namespace slammot::mcap {

/// Which messages are of interest.
struct Selection {
  std::set<std::string> topics;                                     ///< Empty: all.
  std::int64_t from_ns = std::numeric_limits<std::int64_t>::min();  ///< Log time, inclusive.
  std::int64_t to_ns = std::numeric_limits<std::int64_t>::max();    ///< Log time, inclusive.
};

struct Message {
  const Channel* channel = nullptr;
  MessageHead head;
  Bytes data;
};

/// Reads the messages of a file by their log times, those of one time in the order of the file.
/// Only chunks around the present time are in memory. The file must outlive the cursor.
class MessageCursor {
 public:
  MessageCursor(const File& file, Selection selection);

  /// Valid until the next call. None at the end.
  std::optional<Message> next();

  /// Chunks that could not be read, and messages of unknown channels.
  std::uint64_t left_out() const { return left_out_; }

 private:
  struct Place {
    std::int64_t log_time_ns;
    std::size_t offset;
  };
  struct OpenChunk {
    std::vector<std::uint8_t> records;
    std::vector<Place> places;  ///< By time.
    std::size_t at = 0;
  };

  bool is_of_interest(const ChunkIndex& chunk) const;
  void open_chunk(const ChunkIndex& chunk);
  OpenChunk* earliest();
  Message message_at(const OpenChunk& chunk, std::size_t offset) const;

  const File& file_;
  Selection selection_;
  std::set<ChannelId> channels_;           ///< Selected ones.
  std::vector<const ChunkIndex*> chunks_;  ///< To be read, by start time.
  std::size_t next_chunk_ = 0;
  std::deque<OpenChunk> open_;  ///< The first ones may have ended.
  std::uint64_t left_out_ = 0;
};

}  // namespace slammot::mcap
