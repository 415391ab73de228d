#include "services/gateway/map_messages.hpp"

#include <array>

#include "common/files/map_image.hpp"
#include "services/gateway/message_parts.hpp"

namespace slammot::gateway {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

Pixel stationary_pixel(std::uint8_t value) {
  if (value == files::kUnknownPixel) return {0, 0, 0, 0};
  if (value == files::kOccupiedPixel) return {60, 120, 200, 255};
  return {200, 205, 212, 90};
}

/// value: from 254, never seen moving, to 0, always.
Pixel moving_pixel(std::uint8_t value) {
  if (value == files::kUnknownPixel || value >= files::kFreePixel) return {0, 0, 0, 0};
  return {230, 120, 0, static_cast<std::uint8_t>(255 - value)};
}

void add_field(const char* name, std::uint32_t offset, foxglove::Grid& grid) {
  foxglove::PackedElementField& field = *grid.add_fields();
  field.set_name(name);
  field.set_offset(offset);
  field.set_type(foxglove::PackedElementField::UINT8);
}

/// A picture's first row is the top one, a grid's the lowest.
template <typename PixelOf>
std::string cells_of(const files::MapImage& image, PixelOf pixel_of) {
  std::string cells;
  cells.reserve(image.pixels.size() * 4);
  for (std::uint32_t row = image.height; row-- > 0;) {
    for (std::uint32_t column = 0; column < image.width; ++column) {
      const Pixel pixel = pixel_of(image.pixels[std::size_t{row} * image.width + column]);
      cells.append(pixel.begin(), pixel.end());
    }
  }
  return cells;
}

template <typename PixelOf>
std::string grid_of(std::int64_t stamp_ns, const files::MapImage& image, PixelOf pixel_of) {
  foxglove::Grid grid;
  set_time(stamp_ns, *grid.mutable_timestamp());
  grid.set_frame_id(kMapFrame);
  set_pose({image.min_x_m, image.min_y_m, 0.0}, 0.0, *grid.mutable_pose());
  grid.set_column_count(image.width);
  grid.mutable_cell_size()->set_x(image.resolution_m);
  grid.mutable_cell_size()->set_y(image.resolution_m);
  grid.set_cell_stride(4);
  grid.set_row_stride(4 * image.width);
  const std::array names = {"red", "green", "blue", "alpha"};
  for (std::uint32_t i = 0; i < names.size(); ++i) add_field(names[i], i, grid);
  grid.set_data(cells_of(image, pixel_of));
  return grid.SerializeAsString();
}

}  // namespace

MapGrids map_grids(std::int64_t stamp_ns, const std::vector<ShownSubmap>& submaps,
                   std::uint64_t most_cells) {
  std::vector<files::PlacedSubmap> placed;
  for (const ShownSubmap& shown : submaps) {
    if (shown.submap->columns > 0) placed.push_back({shown.submap.get(), shown.map_from_submap});
  }
  const files::MapImages images = files::draw_map(placed, most_cells);
  return {grid_of(stamp_ns, images.stationary, stationary_pixel),
          grid_of(stamp_ns, images.moving, moving_pixel)};
}

}  // namespace slammot::gateway
