#include "common/mcap/records.hpp"

#include <gtest/gtest.h>

#include "common/bags/mcap_format.hpp"

namespace slammot::mcap {
namespace {

Bytes content_of(const Buffer& record) {
  return Bytes(record).subspan(bags::mcap_format::kRecordHeadBytes);
}

TEST(McapRecords, AreLittleEndianAfterOpcodeAndLength) {
  Buffer bytes;
  append(Footer{0x0102030405060708, 0x1112131415161718, 0x21222324}, bytes);
  EXPECT_EQ(bytes, (Buffer{0x02, 20,   0,    0,    0,    0,    0,    0,    0,    0x08,
                           0x07, 0x06, 0x05, 0x04, 0x03, 0x02, 0x01, 0x18, 0x17, 0x16,
                           0x15, 0x14, 0x13, 0x12, 0x11, 0x24, 0x23, 0x22, 0x21}));
}

TEST(McapRecords, ChannelsComeBackAsWritten) {
  const Channel channel{3, 2, "slammot/laser_scan", "cdr", {{"key", "value"}, {"other", ""}}};
  Buffer bytes;
  append(channel, bytes);
  EXPECT_EQ(read_channel(content_of(bytes)), channel);
}

TEST(McapRecords, ThatAreCutAreNoRecords) {
  Buffer bytes;
  append(Channel{3, 2, "topic", "cdr", {{"key", "value"}}}, bytes);
  const Bytes content = content_of(bytes);
  for (std::size_t size = 0; size < content.size(); ++size)
    EXPECT_FALSE(read_channel(content.first(size))) << size;
}

TEST(McapRecords, ASchemaWithoutIdIsNone) {
  Buffer bytes;
  append(Schema{0, "name", "omgidl", {}}, bytes);
  EXPECT_FALSE(read_schema(content_of(bytes)));
}

TEST(McapRecords, ADamagedAttachmentIsNone) {
  Buffer bytes;
  append(Attachment{1, 2, "settings", "text/plain", {'a', 'b', 'c'}}, bytes);
  ASSERT_TRUE(read_attachment(content_of(bytes)));
  EXPECT_EQ(read_attachment(content_of(bytes))->data, (Buffer{'a', 'b', 'c'}));
  bytes[bytes.size() - 5] ^= 1;
  EXPECT_FALSE(read_attachment(content_of(bytes)));
}

}  // namespace
}  // namespace slammot::mcap
