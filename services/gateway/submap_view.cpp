#include "services/gateway/submap_view.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <zlib.h>

namespace slammot::gateway {
namespace {

/// Half-open ranges of columns and rows.
struct Window {
  std::uint32_t first_column, end_column, first_row, end_row;
  std::uint64_t columns() const { return end_column - first_column; }
  std::uint64_t rows() const { return end_row - first_row; }
};

/// Widens the columns by those of the row's cells that are not zero. False if all are.
template <typename Cell>
bool widen(std::span<const Cell> row, Window& window) {
  const auto is_seen = [](Cell cell) { return cell != 0; };
  const auto first = std::find_if(row.begin(), row.end(), is_seen);
  if (first == row.end()) return false;
  const auto end = std::find_if(row.rbegin(), row.rend(), is_seen).base();
  window.first_column =
      std::min(window.first_column, static_cast<std::uint32_t>(first - row.begin()));
  window.end_column = std::max(window.end_column, static_cast<std::uint32_t>(end - row.begin()));
  return true;
}

std::optional<Window> seen_window(const flow::Submap& submap) {
  Window window{submap.columns, 0, submap.rows, 0};
  for (std::uint32_t row = 0; row < submap.rows; ++row) {
    const std::size_t first = std::size_t{row} * submap.columns;
    const bool is_stationary_seen =
        widen(std::span(submap.so_log_odds).subspan(first, submap.columns), window);
    const bool is_motion_seen =
        widen(std::span(submap.mo_evidence).subspan(first, submap.columns), window);
    if (!is_stationary_seen && !is_motion_seen) continue;
    window.first_row = std::min(window.first_row, row);
    window.end_row = row + 1;
  }
  if (window.end_row == 0) return std::nullopt;
  return window;
}

std::uint32_t merged(std::uint64_t cells, std::uint32_t factor) {
  return static_cast<std::uint32_t>((cells + factor - 1) / factor);
}

std::uint32_t merging_factor(const Window& window, std::uint64_t most_cells) {
  std::uint32_t factor = 1;
  while (std::uint64_t{merged(window.columns(), factor)} * merged(window.rows(), factor) >
         most_cells)
    ++factor;
  return factor;
}

/// Cells of a submap, row-major.
struct Cells {
  std::uint32_t columns;
  std::vector<std::int8_t> so_log_odds;
  std::vector<std::uint8_t> mo_evidence;
};

void fill(const Cells& cells, const Window& window, std::uint32_t factor, flow::Submap& view) {
  for (std::uint32_t row = window.first_row; row < window.end_row; ++row) {
    for (std::uint32_t column = window.first_column; column < window.end_column; ++column) {
      const std::size_t from = std::size_t{row} * cells.columns + column;
      const std::size_t to = std::size_t{(row - window.first_row) / factor} * view.columns +
                             (column - window.first_column) / factor;
      const std::int8_t so = cells.so_log_odds[from];
      std::int8_t& so_view = view.so_log_odds[to];
      if (so != 0) so_view = so_view == 0 ? so : std::max(so, so_view);
      view.mo_evidence[to] = std::max(view.mo_evidence[to], cells.mo_evidence[from]);
    }
  }
}

std::string gzip(const std::string& bytes) {
  constexpr int kGzip = 15 + 16;  // window bits, and a header of gzip
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib cannot start");
  std::string compressed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(compressed.data());
  stream.avail_out = static_cast<uInt>(compressed.size());
  deflate(&stream, Z_FINISH);
  compressed.resize(stream.total_out);
  deflateEnd(&stream);
  return compressed;
}

}  // namespace

flow::Submap reduced(flow::Submap view, std::uint64_t most_cells) {
  const auto window = seen_window(view);
  const std::uint32_t factor = window ? merging_factor(*window, most_cells) : 1;
  const Cells cells{view.columns, std::move(view.so_log_odds), std::move(view.mo_evidence)};
  view.surfels = std::vector<flow::Surfel>();
  view.columns = window ? merged(window->columns(), factor) : 0;
  view.rows = window ? merged(window->rows(), factor) : 0;
  view.so_log_odds = std::vector<std::int8_t>(std::size_t{view.columns} * view.rows);
  view.mo_evidence = std::vector<std::uint8_t>(view.so_log_odds.size());
  if (window) {
    view.min_x_m += window->first_column * view.cell_size_m;
    view.min_y_m += window->first_row * view.cell_size_m;
    fill(cells, *window, factor, view);
  }
  view.cell_size_m *= factor;
  return view;
}

std::string compressed_cells(const flow::Submap& submap) {
  std::string bytes(2 * submap.so_log_odds.size(), '\0');
  for (std::size_t cell = 0; cell < submap.so_log_odds.size(); ++cell) {
    bytes[2 * cell] = static_cast<char>(submap.so_log_odds[cell] + 128);
    bytes[2 * cell + 1] = static_cast<char>(submap.mo_evidence[cell]);
  }
  return gzip(bytes);
}

}  // namespace slammot::gateway
