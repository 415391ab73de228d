#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::metrics {

/// How sure an occupancy map is of its cells. Both maps of a comparison need the same scans and cells.
struct MapSharpness {
  std::size_t touched_cells = 0;      ///< That a beam passed or ended in.
  std::size_t occupied_cells = 0;     ///< Of these, more beams ended in it than passed.
  double entropy_bits = 0.0;          ///< Summed over the touched cells: what is still to be known of them.

  double mean_entropy_bits() const { return touched_cells == 0 ? 0.0 : entropy_bits / static_cast<double>(touched_cells); }
};

/// An occupancy map by counting: of the beams that met a cell, how many ended there. A cell of h ends among n beams is
/// occupied with probability (h + 1/2) / (n + 1), the posterior mean after Jeffreys' prior; a blurred wall has cells of
/// which beams say both, and has more of them.
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
