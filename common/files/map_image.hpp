#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/files/result.hpp"
#include "common/flow/submap.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::files {

/// Pixel values of map_server: probability of occupancy is (255 - pixel) / 255.
inline constexpr std::uint8_t kOccupiedPixel = 0;
inline constexpr std::uint8_t kUnknownPixel = 205;
inline constexpr std::uint8_t kFreePixel = 254;

/// A picture of the ground from above, x to the right, y up; the first row of pixels is the top
/// one.
struct MapImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  double resolution_m = 0.0;
  double min_x_m = 0.0;  ///< Lower left corner in map.
  double min_y_m = 0.0;
  std::vector<std::uint8_t> pixels;  ///< Row-major.
};

struct MapImages {
  MapImage stationary;  ///< SO-map: occupied, free, unknown.
  MapImage moving;      ///< MO-map: darker for more frequent motion; unknown if unseen.
};

struct PlacedSubmap {
  const flow::Submap* submap = nullptr;  ///< Not null.
  geometry::Pose2 map_from_submap;
};

/// Limit of pixels per image; larger maps are drawn at two, three, ... times the cell size.
inline constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 26;

/// Merges the submaps into one image. Log-odds of overlapping cells are added; of moving evidence
/// the maximum is used. Covers exactly the seen area. No submaps, or empty ones, give an image of
/// one unknown pixel.
MapImages draw_map(const std::vector<PlacedSubmap>& submaps, std::uint64_t max_pixels = kMaxPixels);

/// Portable grey map, binary.
std::string to_pgm(const MapImage& image);

/// The same as PNG.
Result<std::string> to_png(const MapImage& image);

/// Metadata of the image for map_server.
std::string to_map_server_yaml(const MapImage& image, const std::string& image_file);

}  // namespace slammot::files
