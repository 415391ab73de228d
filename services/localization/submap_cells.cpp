#include "services/localization/submap_cells.hpp"

#include <algorithm>
#include <cstring>

#include "common/grids/lasting_evidence.hpp"

namespace slammot::localization {
namespace {

/// Evidence of a cell that has changed, limited to most_steps. Without a branch in a loop.
std::int8_t changed(std::int8_t now, std::int8_t before, std::int8_t most_steps) {
  const auto least_steps = static_cast<std::int8_t>(-most_steps);
  const std::int8_t raised = now < least_steps ? least_steps : now;
  const std::int8_t limited = raised > most_steps ? most_steps : raised;
  return now != before ? limited : std::int8_t{0};
}

}  // namespace

/// Most rows are the same as before: they are compared as a whole.
grids::GridWindow bounds_of_seen(const grids::GridWindow& window, const Cells& now,
                                 const Cells& before) {
  std::int32_t low_column = window.columns, high_column = -1, low_row = window.rows, high_row = -1;
  const auto columns = static_cast<std::size_t>(window.columns);
  for (std::int32_t row = 0; row < window.rows; ++row) {
    const std::size_t first = static_cast<std::size_t>(row) * columns;
    const bool is_same = std::memcmp(&now.so[first], &before.so[first], columns) == 0 &&
                         std::memcmp(&now.mo[first], &before.mo[first], columns) == 0;
    if (is_same) continue;
    const auto is_seen = [&](std::int32_t column) {
      const std::size_t cell = first + static_cast<std::size_t>(column);
      return now.so[cell] != before.so[cell] || now.mo[cell] > before.mo[cell];
    };
    std::int32_t low = 0;
    while (low < window.columns && !is_seen(low)) ++low;
    if (low == window.columns) continue;
    std::int32_t high = window.columns - 1;
    while (!is_seen(high)) --high;
    low_column = std::min(low_column, low);
    high_column = std::max(high_column, high);
    low_row = std::min(low_row, row);
    high_row = std::max(high_row, row);
  }
  grids::GridWindow bounds = window;
  bounds.columns = std::max(0, high_column - low_column + 1);
  bounds.rows = std::max(0, high_row - low_row + 1);
  if (bounds.columns > 0)
    bounds.first = {window.first.column + low_column, window.first.row + low_row};
  return bounds;
}

// Plain pointers: a compiler must assume that elements of vectors of bytes alias the vectors, and
// does not vectorise their loops.

void put_own_so(const std::int8_t* now, const std::int8_t* before, std::int32_t count,
                std::int8_t* own) {
  for (std::int32_t i = 0; i < count; ++i) {
    const int change = now[i] - before[i];
    const int limited = change < -127 ? -127 : change;
    own[i] = static_cast<std::int8_t>(limited > 127 ? 127 : limited);
  }
}

void put_own_mo(const std::uint8_t* now, const std::uint8_t* before, std::int32_t count,
                std::uint8_t* own) {
  for (std::int32_t i = 0; i < count; ++i) own[i] = now[i] > before[i] ? now[i] : std::uint8_t{0};
}

void keep_changed(std::int8_t* now, const std::int8_t* before, std::size_t count, int most_steps) {
  const auto most = static_cast<std::int8_t>(most_steps);
  for (std::size_t i = 0; i < count; ++i) now[i] = changed(now[i], before[i], most);
}

void keep_changed_or_driven_over(std::int8_t* now, const std::int8_t* before, std::size_t count,
                                 int most_steps) {
  const auto most = static_cast<std::int8_t>(most_steps);
  for (std::size_t i = 0; i < count; ++i)
    now[i] =
        grids::LastingEvidence::is_driven_over(now[i]) ? now[i] : changed(now[i], before[i], most);
}

}  // namespace slammot::localization
