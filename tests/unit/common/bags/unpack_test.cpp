#include "common/bags/unpack.hpp"

#include <gtest/gtest.h>

#include "tests/support/bag_bytes.hpp"

namespace slammot::bags {
namespace {

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class UnpackOf : public ::testing::TestWithParam<const char*> {
 protected:
  std::string plain_ = [] {
    std::string text;
    for (int i = 0; i < 50'000; ++i) text += std::to_string(i * 7919 % 1000) + " ";
    return text;
  }();
  std::string packed_ = testing::packed(GetParam(), plain_);
};

TEST_P(UnpackOf, GivesBackWhatWasPacked) {
  const Unpacked unpacked = unpack(GetParam(), bytes_of(packed_));
  EXPECT_TRUE(unpacked.is_whole);
  EXPECT_EQ(text_of(unpacked.bytes), plain_);
}

TEST_P(UnpackOf, GivesWhatComesBeforeACut) {
  const Unpacked unpacked = unpack(GetParam(), bytes_of(packed_.substr(0, packed_.size() - 20)));
  EXPECT_FALSE(unpacked.is_whole);
  EXPECT_TRUE(plain_.starts_with(text_of(unpacked.bytes)));
}

TEST_P(UnpackOf, StopsWhereItBecomesTooMuch) {
  const Unpacked unpacked = unpack(GetParam(), bytes_of(packed_), 1000);
  EXPECT_FALSE(unpacked.is_whole);
  EXPECT_EQ(unpacked.bytes.size(), 1000U);
}

TEST_P(UnpackOf, RefusesOtherBytes) {
  EXPECT_FALSE(unpack(GetParam(), bytes_of("these are no packed bytes at all")).is_whole);
}

INSTANTIATE_TEST_SUITE_P(Compressions, UnpackOf, ::testing::Values("bz2", "lz4", "zstd"));

TEST(Unpack, KnowsNoOtherCompression) {
  EXPECT_FALSE(can_unpack("gzip"));
  EXPECT_FALSE(unpack("gzip", bytes_of("abc")).is_whole);
  EXPECT_EQ(text_of(unpack("none", bytes_of("abc")).bytes), "abc");
}

TEST(Crc32, IsThatOfIeee) { EXPECT_EQ(crc32_of(bytes_of("123456789")), 0xCBF43926U); }

}  // namespace
}  // namespace slammot::bags
