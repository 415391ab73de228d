#include "common/bags/byte_reader.hpp"

#include <array>

#include <gtest/gtest.h>

namespace slammot::bags {
namespace {

constexpr std::array<std::uint8_t, 6> kBytes = {1, 2, 3, 4, 5, 6};

TEST(ByteReader, TakesNumbersInEitherOrder) {
  EXPECT_EQ(ByteReader(kBytes).number<std::uint32_t>(), 0x04030201U);
  EXPECT_EQ(ByteReader(kBytes, std::endian::big).number<std::uint16_t>(), 0x0102U);
}

TEST(ByteReader, GivesNothingMoreOnceItWasAskedForTooMuch) {
  ByteReader reader(kBytes);
  EXPECT_EQ(reader.number<std::uint32_t>(), 0x04030201U);
  EXPECT_TRUE(reader.is_ok());
  EXPECT_EQ(reader.number<std::uint32_t>(), 0U);
  EXPECT_FALSE(reader.is_ok());
  EXPECT_EQ(reader.number<std::uint8_t>(), 0U);
  EXPECT_TRUE(reader.take(0).empty());
}

TEST(ByteReader, DoesNotBelieveASizeBeyondTheEnd) {
  constexpr std::array<std::uint8_t, 6> kSaysMuch = {0xFF, 0xFF, 0xFF, 0xFF, 'a', 'b'};
  ByteReader reader(kSaysMuch);
  EXPECT_TRUE(reader.text().empty());
  EXPECT_FALSE(reader.is_ok());
}

}  // namespace
}  // namespace slammot::bags
