#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/mcap/records.hpp"

namespace slammot::mcap {

/// What an MCAP file holds, without its messages.
struct Contents {
  Header header;
  std::map<SchemaId, Schema> schemas;
  std::map<ChannelId, Channel> channels;
  std::vector<ChunkIndex> chunks;  ///< Sound ones, in the order of the file.
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  Statistics statistics;
  bool is_whole = false;             ///< It has its end, with a summary.
  std::uint64_t data_crc = 0;        ///< As the data end states it; 0: not stated.
  std::uint64_t end_of_data = 0;     ///< Where whole records end, without those after the data end.
  std::uint64_t loose_messages = 0;  ///< Outside of chunks: left out here, no index finds them.
  std::vector<std::string> damage;   ///< What is wrong and where; empty for a sound file.
};

}  // namespace slammot::mcap
