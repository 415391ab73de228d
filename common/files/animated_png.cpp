#include "common/files/animated_png.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <string_view>
#include <utility>

#include <zlib.h>

namespace slammot::files {
namespace {

constexpr std::size_t kMostColours = 256;
constexpr std::uint8_t kDepth = 8;
constexpr std::uint8_t kPaletteType = 3;
constexpr int kCompression = 9;

void append_big_endian(std::string& text, std::uint32_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    text += static_cast<char>(value >> shift & 0xFFU);
}

/// Length, name, content and checksum over name and content.
void append_chunk(std::string& file, std::string_view name, const std::string& content) {
  append_big_endian(file, static_cast<std::uint32_t>(content.size()), 4);
  const std::size_t begin = file.size();
  file.append(name).append(content);
  const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(file.data() + begin),
                              static_cast<uInt>(file.size() - begin));
  append_big_endian(file, static_cast<std::uint32_t>(checksum), 4);
}

std::uint32_t key_of(const Rgb& colour) {  // five bits a channel
  return static_cast<std::uint32_t>(colour[0] >> 3 << 10 | colour[1] >> 3 << 5 | colour[2] >> 3);
}

constexpr std::size_t kKeys = 1U << 15;

struct Palette {
  std::vector<Rgb> colours;
  std::vector<std::uint8_t> index_of_key;  ///< Of the nearest colour.
};

/// The most frequent colours; each is the mean of those that share its key.
std::vector<Rgb> frequent_colours(const Animation& animation) {
  std::vector<std::uint64_t> counts(kKeys);
  std::vector<std::array<std::uint64_t, 3>> sums(kKeys);
  for (const RgbImage& frame : animation.frames) {
    for (const Rgb& colour : frame.pixels) {
      const std::uint32_t key = key_of(colour);
      ++counts[key];
      for (std::size_t i = 0; i < 3; ++i) sums[key][i] += colour[i];
    }
  }
  std::vector<std::uint32_t> keys;
  for (std::uint32_t key = 0; key < kKeys; ++key)
    if (counts[key] > 0) keys.push_back(key);
  std::ranges::sort(keys, [&](std::uint32_t a, std::uint32_t b) {
    return counts[a] != counts[b] ? counts[a] > counts[b] : a < b;
  });
  keys.resize(std::min(keys.size(), kMostColours));
  std::vector<Rgb> colours;
  for (const std::uint32_t key : keys) {
    Rgb mean;
    for (std::size_t i = 0; i < 3; ++i)
      mean[i] = static_cast<std::uint8_t>(sums[key][i] / counts[key]);
    colours.push_back(mean);
  }
  return colours;
}

Palette palette_of(const Animation& animation) {
  Palette palette{frequent_colours(animation), std::vector<std::uint8_t>(kKeys)};
  for (std::uint32_t key = 0; key < kKeys; ++key) {
    const std::array<int, 3> colour = {static_cast<int>(key >> 10 << 3) + 4,
                                       static_cast<int>(key >> 5 & 31U) * 8 + 4,
                                       static_cast<int>(key & 31U) * 8 + 4};
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < palette.colours.size(); ++i) {
      int squared = 0;
      for (std::size_t j = 0; j < 3; ++j)
        squared += (colour[j] - palette.colours[i][j]) * (colour[j] - palette.colours[i][j]);
      if (squared >= least) continue;
      least = squared;
      palette.index_of_key[key] = static_cast<std::uint8_t>(i);
    }
  }
  return palette;
}

struct Rectangle {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t width = 1;
  std::uint32_t height = 1;
};

using Indices = std::vector<std::uint8_t>;

Indices indices_of(const RgbImage& frame, const Palette& palette) {
  Indices indices(frame.pixels.size());
  std::ranges::transform(frame.pixels, indices.begin(),
                         [&](const Rgb& colour) { return palette.index_of_key[key_of(colour)]; });
  return indices;
}

/// What differs; one pixel where nothing does.
Rectangle difference(const Indices& a, const Indices& b, std::uint32_t width) {
  Rectangle box{0, 0, 1, 1};
  std::uint32_t x0 = width, x1 = 0, y0 = 0, y1 = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    const auto x = static_cast<std::uint32_t>(i % width);
    const auto y = static_cast<std::uint32_t>(i / width);
    if (x0 == width) y0 = y;
    x0 = std::min(x0, x);
    x1 = std::max(x1, x);
    y1 = y;
  }
  if (x0 < width) box = {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
  return box;
}

/// Rows with filter type 0, compressed.
std::string compressed(const Indices& pixels, std::uint32_t width, const Rectangle& box) {
  std::string rows;
  for (std::uint32_t y = box.y; y < box.y + box.height; ++y) {
    rows += '\0';
    rows.append(reinterpret_cast<const char*>(pixels.data()) + std::size_t{y} * width + box.x,
                box.width);
  }
  uLongf size = compressBound(rows.size());
  std::string data(size, '\0');
  compress2(reinterpret_cast<Bytef*>(data.data()), &size,
            reinterpret_cast<const Bytef*>(rows.data()), rows.size(), kCompression);
  data.resize(size);
  return data;
}

std::string frame_control(std::uint32_t sequence, const Rectangle& box, std::uint16_t frame_ms) {
  std::string content;
  for (const std::uint32_t value : {sequence, box.width, box.height, box.x, box.y})
    append_big_endian(content, value, 4);
  append_big_endian(content, frame_ms, 2);
  append_big_endian(content, 1000, 2);  // of a second
  return content.append(2, '\0');       // leaves the frame as it is; overwrites the rectangle
}

std::string header_of(const RgbImage& frame) {
  std::string content;
  append_big_endian(content, frame.width, 4);
  append_big_endian(content, frame.height, 4);
  content += static_cast<char>(kDepth);
  content += static_cast<char>(kPaletteType);
  return content.append(3, '\0');  // deflate, filters by row, not interlaced
}

}  // namespace

std::string to_animated_png(const Animation& animation) {
  assert(!animation.frames.empty());
  const RgbImage& first = animation.frames.front();
  const Palette palette = palette_of(animation);
  std::string file = "\x89PNG\r\n\x1a\n";
  append_chunk(file, "IHDR", header_of(first));
  std::string control;
  append_big_endian(control, static_cast<std::uint32_t>(animation.frames.size()), 4);
  append_big_endian(control, 0, 4);  // for ever
  append_chunk(file, "acTL", control);
  std::string colours;
  for (const Rgb& colour : palette.colours)
    for (const std::uint8_t value : colour) colours += static_cast<char>(value);
  append_chunk(file, "PLTE", colours);
  std::uint32_t sequence = 0;
  Indices before;
  for (const RgbImage& frame : animation.frames) {
    assert(frame.width == first.width && frame.height == first.height);
    Indices pixels = indices_of(frame, palette);
    const Rectangle box = before.empty() ? Rectangle{0, 0, first.width, first.height}
                                         : difference(before, pixels, first.width);
    append_chunk(file, "fcTL", frame_control(sequence++, box, animation.frame_ms));
    const std::string data = compressed(pixels, first.width, box);
    if (before.empty()) {
      append_chunk(file, "IDAT", data);
    } else {
      std::string numbered;
      append_big_endian(numbered, sequence++, 4);
      append_chunk(file, "fdAT", numbered + data);
    }
    before = std::move(pixels);
  }
  append_chunk(file, "IEND", {});
  return file;
}

}  // namespace slammot::files
