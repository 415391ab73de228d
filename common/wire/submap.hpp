#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "common/flow/submap.hpp"
#include "common/wire/decoded.hpp"
#include "idl/mapping.h"

namespace slammot::wire {

/// Cells along the side of a tile.
inline constexpr std::uint32_t kTileSide = 128;
/// Most cells of a submap, 16 MB a grid: 400 m x 400 m in cells of 0.1 m.
inline constexpr std::uint64_t kMostCells = 1U << 24;
inline constexpr std::uint32_t kMostSurfels = 1U << 20;

/// Splits submaps into tiles that fit on the bus; reuses its buffers.
class SubmapEncoder {
 public:
  /// Calls `write` with each tile, which is good only during the call. Tiles in which nothing was
  /// seen are left out, but for an empty submap's only one. Throws std::length_error for a submap
  /// that is larger than the bus carries, and std::invalid_argument where its grids are not columns
  /// x rows.
  void encode(std::string_view vehicle_id, const flow::Submap& submap,
              const std::function<void(const slammot_SubmapTile&)>& write);

 private:
  struct Rectangle {
    std::uint32_t first_column, first_row, columns, rows;
  };

  void find_rectangles(const flow::Submap& submap);
  void fill_rectangle(const flow::Submap& submap, const Rectangle& rectangle);
  void fill_surfels(const flow::Submap& submap, std::uint32_t first, std::uint32_t end);
  void fill_measurements(const flow::Submap& submap, std::uint32_t tile);

  slammot_SubmapTile sample_{};
  std::vector<Rectangle> rectangles_;
  std::vector<std::uint8_t> so_log_odds_plus_128_;
  std::vector<std::uint8_t> mo_evidence_;
  std::vector<slammot_Surfel> surfels_;
  std::vector<slammot_SubmapFix> fixes_;
  std::vector<slammot_SubmapHeading> headings_;
};

/// Reassembles submaps from tiles in any order, repeated, and of several submaps at a time, as late
/// joiners receive them. Use one a vehicle.
class SubmapAssembler {
 public:
  struct Counters {
    std::uint64_t tiles = 0;
    std::uint64_t repeated_tiles = 0;
    std::uint64_t faulty_tiles = 0;
    std::uint64_t replaced_submaps = 0;  ///< A new version of a submap came before the old one was
                                         ///< complete.
  };

  /// The submap if this was its last missing tile. Nothing (and no fault) if tiles are missing, or
  /// if the submap was complete before and has not changed. Submaps become complete in any order.
  struct Added {
    std::optional<flow::Submap> submap;
    std::uint64_t content_hash = 0;  ///< Of the submap.
    std::string_view fault;          ///< Reason of rejection; empty if accepted.
  };
  Added add(const slammot_SubmapTile& tile);

  const Counters& counters() const { return counters_; }
  /// Number of incomplete submaps.
  std::size_t incomplete() const { return partial_.size(); }

 private:
  struct Partial {
    slammot_SubmapHeader header;
    std::vector<bool> has_tile;
    std::uint32_t missing_tiles;
    flow::Submap submap;
  };

  Partial& partial_of(const slammot_SubmapTile& tile);
  Added complete(flow::SubmapId submap_id);

  std::map<flow::SubmapId, Partial> partial_;
  std::map<flow::SubmapId, std::uint64_t> content_hash_of_complete_;
  Counters counters_;
};

/// FNV-1a (64 bits) over the submap without its number.
std::uint64_t content_hash(const flow::Submap& submap);

}  // namespace slammot::wire
