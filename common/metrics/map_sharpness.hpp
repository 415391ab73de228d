#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::metrics {

/// Certainty of an occupancy map. Two maps to compare need the same scans and cells.
struct MapSharpness {
  std::size_t touched_cells = 0;   ///< Cells that a beam crossed or ended in.
  std::size_t occupied_cells = 0;  ///< Of these, cells in which more beams ended than crossed.
  double entropy_bits = 0.0;       ///< Sum of the entropies of the touched cells.

  double mean_entropy_bits() const {
    return touched_cells == 0 ? 0.0 : entropy_bits / static_cast<double>(touched_cells);
  }
};

/// Occupancy map by counting. A cell with h ends among n beams is occupied with probability (h +
/// 1/2) / (n + 1), the posterior mean under Jeffreys' prior. A blurred wall has more cells, with
/// contradicting beams.
class EndCounts {
 public:
  /// Cells are squares of a lattice that has a corner at the origin.
  explicit EndCounts(double cell_size_m) : cell_size_m_(cell_size_m) {}

  /// One beam that ended in an echo. Everything in one frame.
  void add(const geometry::Vector2& origin_m, const geometry::Vector2& end_m);

  MapSharpness sharpness() const;

 private:
  static constexpr std::int32_t kTileShift = 5;  // tiles of 32 x 32 cells
  static constexpr std::int32_t kInTile = (1 << kTileShift) - 1;
  struct Count {
    std::uint32_t ends = 0;
    std::uint32_t beams = 0;
  };

  Count& at(std::int32_t column, std::int32_t row);

  double cell_size_m_;
  std::unordered_map<std::uint64_t, std::vector<Count>> tiles_;
};

}  // namespace slammot::metrics
