#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/files/result.hpp"

namespace slammot::files {

using Rgb = std::array<std::uint8_t, 3>;

/// A picture with at most 256 colours; the first row of pixels is the top one.
struct IndexedImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<Rgb> palette;          ///< 1 to 256 colours.
  std::vector<std::uint8_t> pixels;  ///< Row-major, each an index of the palette.
};

/// A picture of true colours; the first row of pixels is the top one.
struct RgbImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<Rgb> pixels;  ///< Row-major.
};

/// A picture of grey values; the first row of pixels is the top one.
struct GreyImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::span<const std::uint8_t> pixels;  ///< Row-major.
};

/// A PNG file. `compression`: zlib's level, 1 (fast) to 9. Fails for sizes that PNG cannot hold.
Result<std::string> to_png(const IndexedImage& image, int compression = 6);
Result<std::string> to_png(const RgbImage& image, int compression = 6);
/// For pictures of few grey values.
Result<std::string> to_png(const GreyImage& image, int compression = 6);

}  // namespace slammot::files
