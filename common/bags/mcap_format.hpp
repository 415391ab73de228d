#pragma once

#include <cstdint>
#include <string_view>

/// Constants of MCAP files: mcap.dev/spec, version 0.
namespace slammot::bags::mcap_format {

/// Begins and ends a file.
inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
/// Opcode and length before the content of a record.
inline constexpr std::size_t kRecordHeadBytes = 9;
/// Content of a footer, which has a fixed size.
inline constexpr std::size_t kFooterBytes = 20;
/// Before the data of a message: channel, sequence, two times.
inline constexpr std::size_t kMessageHeadBytes = 22;

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
  kLastKnown = 0x0F,
  kFirstPrivate = 0x80,
};

inline bool is_opcode(std::uint8_t opcode) {
  return (opcode >= kHeader && opcode <= kLastKnown) || opcode >= kFirstPrivate;
}

}  // namespace slammot::bags::mcap_format
