#include "common/metrics/map_sharpness.hpp"

#include <cmath>

#include "common/grids/ray_walk.hpp"

namespace slammot::metrics {
namespace {

double entropy_bits(double probability) {
  return -probability * std::log2(probability) - (1.0 - probability) * std::log2(1.0 - probability);
}

}  // namespace

EndCounts::Count& EndCounts::at(std::int32_t column, std::int32_t row) {
  const auto upper = static_cast<std::uint64_t>(static_cast<std::uint32_t>(row >> kTileShift))
                     << 32;
  std::vector<Count>& tile = tiles_[upper | static_cast<std::uint32_t>(column >> kTileShift)];
  if (tile.empty()) tile.resize(std::size_t{1} << (2 * kTileShift));
  return tile[static_cast<std::size_t>((row & kInTile) << kTileShift | (column & kInTile))];
}

void EndCounts::add(const geometry::Vector2& origin_m, const geometry::Vector2& end_m) {
  const grids::Cell last = {static_cast<std::int32_t>(std::floor(end_m.x() / cell_size_m_)),
                            static_cast<std::int32_t>(std::floor(end_m.y() / cell_size_m_))};
  const double length_m = (end_m - origin_m).norm();
  if (length_m > 0.0) {
    grids::RayWalk walk(origin_m, (end_m - origin_m) / length_m, cell_size_m_);
    for (; walk.distance_m() < length_m && walk.cell() != last; walk.advance())
      ++at(walk.cell().column, walk.cell().row).beams;
  }
  Count& end = at(last.column, last.row);
  ++end.ends;
  ++end.beams;
}

MapSharpness EndCounts::sharpness() const {
  MapSharpness sharpness;
  for (const auto& [key, tile] : tiles_) {
    for (const Count& count : tile) {
      if (count.beams == 0) continue;
      ++sharpness.touched_cells;
      if (2 * count.ends > count.beams) ++sharpness.occupied_cells;
      sharpness.entropy_bits += entropy_bits((count.ends + 0.5) / (count.beams + 1.0));
    }
  }
  return sharpness;
}

}  // namespace slammot::metrics
