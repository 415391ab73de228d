#include "services/evaluator/map_cells.hpp"

namespace slammot::evaluator {

metrics::OccupancyCells cells_of(const files::MapImage& image) {
  metrics::OccupancyCells cells{image.width,   image.height,  image.resolution_m,
                                image.min_x_m, image.min_y_m, {}};
  cells.state.reserve(image.pixels.size());
  for (std::size_t row = 0; row < image.height; ++row) {
    const auto first =
        image.pixels.begin() + static_cast<std::ptrdiff_t>((image.height - 1 - row) * image.width);
    for (auto pixel = first; pixel != first + static_cast<std::ptrdiff_t>(image.width); ++pixel) {
      cells.state.push_back(*pixel == files::kOccupiedPixel ? metrics::CellState::kOccupied
                            : *pixel == files::kFreePixel   ? metrics::CellState::kFree
                                                            : metrics::CellState::kUnknown);
    }
  }
  return cells;
}

}  // namespace slammot::evaluator
