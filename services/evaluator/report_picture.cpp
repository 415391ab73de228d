#include "services/evaluator/report_picture.hpp"

#include <algorithm>
#include <array>

namespace slammot::evaluator {
namespace {

constexpr std::uint32_t kMostPixels = 4096;  // along a side
constexpr int kCompression = 2;

/// What page/ground.js takes as certain, in 1/16 of log-odds.
constexpr std::array<std::uint8_t, 3> kEvidence = {128, 128 - 16, 128 + 64};

std::uint8_t ground_of(std::uint8_t pixel) {
  if (pixel == files::kUnknownPixel) return 0;
  return pixel == files::kOccupiedPixel ? 2 : 1;
}

/// 0 where the pixel of moving.pgm has no motion or is unseen.
std::uint8_t motion_of(std::uint8_t pixel) {
  if (pixel == files::kUnknownPixel || pixel >= files::kFreePixel) return 0;
  const int share = files::kFreePixel - pixel;  // of 254
  return static_cast<std::uint8_t>(
      std::clamp(1 + share * (kMotionLevels - 1) / (files::kFreePixel + 1), 1, kMotionLevels - 1));
}

std::vector<files::Rgb> palette() {
  std::vector<files::Rgb> colours;
  for (int motion = 0; motion < kMotionLevels; ++motion) {
    for (const std::uint8_t evidence : kEvidence)
      colours.push_back(
          {evidence, static_cast<std::uint8_t>(255 * motion / (kMotionLevels - 1)), 0});
  }
  return colours;
}

/// Of a block of pixels the greatest value of `value_of`.
template <typename ValueOf>
void reduce(const files::MapImage& map, std::uint32_t step, ValueOf value_of, std::uint8_t factor,
            files::IndexedImage& image) {
  std::vector<std::uint8_t> line(image.width);
  for (std::uint32_t row = 0; row < image.height; ++row) {
    std::ranges::fill(line, std::uint8_t{0});
    const std::uint32_t end = std::min(map.height, (row + 1) * step);
    for (std::uint32_t from = row * step; from < end; ++from) {
      const std::uint8_t* const pixels = map.pixels.data() + std::size_t{from} * map.width;
      for (std::uint32_t x = 0, column = 0; x < map.width; x += step, ++column) {
        std::uint8_t most = line[column];
        for (std::uint32_t i = x; i < std::min(map.width, x + step); ++i)
          most = std::max(most, value_of[pixels[i]]);
        line[column] = most;
      }
    }
    std::uint8_t* const to = image.pixels.data() + std::size_t{row} * image.width;
    for (std::uint32_t column = 0; column < image.width; ++column)
      to[column] = static_cast<std::uint8_t>(to[column] + factor * line[column]);
  }
}

std::array<std::uint8_t, 256> table_of(std::uint8_t (*value_of)(std::uint8_t)) {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t pixel = 0; pixel < table.size(); ++pixel)
    table[pixel] = value_of(static_cast<std::uint8_t>(pixel));
  return table;
}

}  // namespace

files::IndexedImage joined_maps(const files::MapImage& map, const files::MapImage* moving,
                                std::uint32_t step) {
  files::IndexedImage image{
      (map.width + step - 1) / step, (map.height + step - 1) / step, palette(), {}};
  image.pixels.resize(std::size_t{image.width} * image.height);
  reduce(map, step, table_of(ground_of), 1, image);
  if (moving != nullptr && moving->width == map.width && moving->height == map.height)
    reduce(*moving, step, table_of(motion_of), 3, image);
  return image;
}

std::optional<ReportPicture> draw_picture(const RunResult& result) {
  if (!result.map || result.map->width == 0 || result.map->height == 0) return std::nullopt;
  const files::MapImage& map = *result.map;
  const std::uint32_t step = (std::max(map.width, map.height) + kMostPixels - 1) / kMostPixels;
  const files::IndexedImage image =
      joined_maps(map, result.moving ? &*result.moving : nullptr, step);
  const auto png = files::to_png(image, kCompression);
  if (!png) return std::nullopt;
  const double pixel_m = map.resolution_m * step;
  const double height_m = pixel_m * image.height;
  // The first row of a picture is its top: a last row that is not full reaches below the map.
  return ReportPicture{*png, map.min_x_m, map.min_y_m + map.resolution_m * map.height - height_m,
                       pixel_m * image.width, height_m};
}

}  // namespace slammot::evaluator
