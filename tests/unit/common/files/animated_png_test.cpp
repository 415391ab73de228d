#include "common/files/animated_png.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

namespace slammot::files {
namespace {

using ::testing::ElementsAre;

constexpr Rgb kBlack = {0, 0, 0};
constexpr Rgb kRed = {255, 0, 0};

struct Chunk {
  std::string name;
  std::string content;
  bool is_sound = false;
};

std::uint32_t number_at(const std::string& text, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(text[at + i]);
  return value;
}

std::vector<Chunk> chunks_of(const std::string& file) {
  std::vector<Chunk> chunks;
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::uint32_t size = number_at(file, at);
    const std::string named = file.substr(at + 4, size + 4);
    const auto checksum =
        crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
    chunks.push_back(
        {named.substr(0, 4), named.substr(4), checksum == number_at(file, at + 8 + size)});
    at += 12 + size;
  }
  return chunks;
}

RgbImage picture(std::uint32_t width, std::uint32_t height, const Rgb& colour) {
  return {width, height, std::vector<Rgb>(std::size_t{width} * height, colour)};
}

Animation moving_dot() {
  Animation animation{{picture(8, 4, kBlack), picture(8, 4, kBlack), picture(8, 4, kBlack)}, 125};
  animation.frames[1].pixels[8 + 3] = kRed;      // x 3, y 1
  animation.frames[2].pixels[2 * 8 + 5] = kRed;  // x 5, y 2
  return animation;
}

TEST(AnimatedPng, HasTheChunksOfTheSpecificationInTheirOrder) {
  std::vector<std::string> names;
  for (const Chunk& chunk : chunks_of(to_animated_png(moving_dot()))) {
    names.push_back(chunk.name);
    EXPECT_TRUE(chunk.is_sound) << chunk.name;
  }
  EXPECT_THAT(names, ElementsAre("IHDR", "acTL", "PLTE", "fcTL", "IDAT", "fcTL", "fdAT", "fcTL",
                                 "fdAT", "IEND"));
}

TEST(AnimatedPng, NumbersControlAndDataOfFramesInOneSequence) {
  std::vector<std::uint32_t> numbers;
  for (const Chunk& chunk : chunks_of(to_animated_png(moving_dot())))
    if (chunk.name == "fcTL" || chunk.name == "fdAT")
      numbers.push_back(number_at(chunk.content, 0));
  EXPECT_THAT(numbers, ElementsAre(0, 1, 2, 3, 4));
}

TEST(AnimatedPng, WritesOnlyTheRectangleThatChanges) {
  std::vector<std::uint32_t> boxes;
  for (const Chunk& chunk : chunks_of(to_animated_png(moving_dot())))
    if (chunk.name == "fcTL")
      for (const std::size_t at : {4U, 8U, 12U, 16U}) boxes.push_back(number_at(chunk.content, at));
  EXPECT_THAT(boxes, ElementsAre(8, 4, 0, 0,    // width, height, x, y of the first frame
                                 1, 1, 3, 1,    // the dot comes
                                 3, 2, 3, 1));  // and moves
}

TEST(AnimatedPng, KeepsFewColoursExactly) {
  const auto chunks = chunks_of(to_animated_png(moving_dot()));
  EXPECT_EQ(chunks[2].content, std::string("\0\0\0\xff\0\0", 6));
}

TEST(PngOfPixels, BeginsWithItsSignatureAndSize) {
  const auto png = to_png(picture(3, 2, kRed));
  ASSERT_TRUE(png);
  EXPECT_EQ(png->substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(number_at(*png, 16), 3U);
  EXPECT_EQ(number_at(*png, 20), 2U);
}

}  // namespace
}  // namespace slammot::files
