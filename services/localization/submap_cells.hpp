#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/grids/grid_window.hpp"

namespace slammot::localization {

/// Evidence of one window, row-major.
struct Cells {
  const std::vector<std::int8_t>& so;
  const std::vector<std::uint8_t>& mo;
};

/// Smallest window that holds every cell in which something was seen since `before`; without cells
/// where nothing was.
grids::GridWindow bounds_of_seen(const grids::GridWindow& window, const Cells& now,
                                 const Cells& before);

/// Evidence that a submap has seen itself: the present one without the inherited one, in `count`
/// cells.
void put_own_so(const std::int8_t* now, const std::int8_t* before, std::int32_t count,
                std::int8_t* own);
void put_own_mo(const std::uint8_t* now, const std::uint8_t* before, std::int32_t count,
                std::uint8_t* own);

/// Clears cells that have not changed and limits the others to most_steps of log-odds.
void keep_changed(std::int8_t* now, const std::int8_t* before, std::size_t count, int most_steps);

/// The same of lasting evidence; cells that were driven over stay.
void keep_changed_or_driven_over(std::int8_t* now, const std::int8_t* before, std::size_t count,
                                 int most_steps);

}  // namespace slammot::localization
