#include "common/wire/submap.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

constexpr std::uint32_t kMostSurfelsOfTile = 4608;
// Limits the memory of incomplete submaps; several times the submaps of a day's drive.
constexpr std::size_t kMostIncompleteSubmaps = 4096;

std::uint32_t divide_up(std::uint32_t dividend, std::uint32_t divisor) {
  return (dividend + divisor - 1) / divisor;
}

std::uint32_t most_tiles(std::uint32_t columns, std::uint32_t rows, std::uint32_t surfels) {
  const std::uint32_t of_grids = divide_up(columns, kTileSide) * divide_up(rows, kTileSide);
  return std::max({of_grids, divide_up(surfels, kMostSurfelsOfTile), 1U});
}

class Fnv1a {
 public:
  template <typename Number>
  void add(Number number) {
    static_assert(std::is_arithmetic_v<Number>);
    add_all(std::span<const Number>(&number, 1));
  }

  template <typename Number>
  void add_all(std::span<const Number> numbers) {
    for (const std::byte byte : std::as_bytes(numbers)) {
      hash_ = (hash_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
    }
  }

  void add(const geometry::Pose2& pose) {
    add(pose.x_m);
    add(pose.y_m);
    add(pose.heading_rad);
  }

  std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

slammot_SubmapHeader encode_header(const flow::Submap& submap, std::uint32_t tiles) {
  slammot_SubmapHeader header{};
  header.map_id = submap.map_id.value;
  header.first_stamp_ns = submap.first_stamp_ns;
  header.last_stamp_ns = submap.last_stamp_ns;
  header.odom_from_submap = encode(submap.odom_from_submap);
  header.previous_from_submap = encode(submap.previous_from_submap);
  header.submap_from_base_at_end = encode(submap.submap_from_base_at_end);
  header.travelled_m = submap.travelled_m;
  header.cell_size_m = submap.cell_size_m;
  header.min_x_m = submap.min_x_m;
  header.min_y_m = submap.min_y_m;
  header.column_count = submap.columns;
  header.row_count = submap.rows;
  header.surfel_count = static_cast<std::uint32_t>(submap.surfels.size());
  header.saliency = submap.saliency;
  header.tile_count = tiles;
  header.content_hash = content_hash(submap);
  return header;
}

/// A submap from its header, with empty grids and surfels.
flow::Submap empty_submap(flow::SubmapId submap_id, const slammot_SubmapHeader& header) {
  const std::size_t cells = std::size_t{header.column_count} * header.row_count;
  return {.map_id = {header.map_id},
          .submap_id = submap_id,
          .first_stamp_ns = header.first_stamp_ns,
          .last_stamp_ns = header.last_stamp_ns,
          .odom_from_submap = decode(header.odom_from_submap),
          .previous_from_submap = decode(header.previous_from_submap),
          .submap_from_base_at_end = decode(header.submap_from_base_at_end),
          .travelled_m = header.travelled_m,
          .cell_size_m = header.cell_size_m,
          .min_x_m = header.min_x_m,
          .min_y_m = header.min_y_m,
          .columns = header.column_count,
          .rows = header.row_count,
          .so_log_odds = std::vector<std::int8_t>(cells, 0),
          .mo_evidence = std::vector<std::uint8_t>(cells, 0),
          .surfels = std::vector<flow::Surfel>(header.surfel_count),
          .saliency = header.saliency};
}

std::string_view fault_of(const slammot_SubmapHeader& header) {
  if (!is_sound(header.odom_from_submap)) return "odom_from_submap is not finite";
  if (!is_sound(header.previous_from_submap))
    return "previous_from_submap or its covariance is unsound";
  if (!is_sound(header.submap_from_base_at_end)) return "submap_from_base_at_end is not finite";
  if (!is_amount(header.travelled_m)) return "travelled_m is negative or not finite";
  if (!is_amount(header.cell_size_m) || header.cell_size_m == 0.0)
    return "cell_size_m is not above zero";
  if (!is_sound(header.min_x_m) || !is_sound(header.min_y_m))
    return "the grid's corner is not finite";
  if (!is_sound(header.saliency)) return "saliency is not finite";
  if (std::uint64_t{header.column_count} * header.row_count > kMostCells)
    return "the grid is too large";
  if (header.surfel_count > kMostSurfels) return "there are too many surfels";
  if (header.tile_count == 0 ||
      header.tile_count > most_tiles(header.column_count, header.row_count, header.surfel_count)) {
    return "tile_count does not go with the size";
  }
  return "";
}

bool is_inside(std::uint32_t first, std::uint32_t count, std::uint32_t size) {
  return std::uint64_t{first} + count <= size;
}

std::string_view fault_of_measurements(const slammot_SubmapTile& tile) {
  for (const slammot_SubmapFix& fix : elements(tile.fixes)) {
    const bool is_on_earth =
        std::abs(fix.latitude_deg) <= 90.0 && std::abs(fix.longitude_deg) <= 360.0;
    if (!is_on_earth || !is_sound(fix.x_m) || !is_sound(fix.y_m) ||
        !is_amount(fix.east_variance_m2) || !is_amount(fix.north_variance_m2) ||
        !is_sound(fix.covariance_m2))
      return "a fix is not finite";
  }
  for (const slammot_SubmapHeading& heading : elements(tile.headings)) {
    if (!is_sound(heading.in_submap_rad) || !is_sound(heading.from_east_rad) ||
        !is_amount(heading.sigma_rad))
      return "a heading is not finite";
  }
  return "";
}

std::string_view fault_of(const slammot_SubmapTile& tile) {
  const slammot_SubmapHeader& header = tile.header;
  if (const std::string_view fault = fault_of(header); !fault.empty()) return fault;
  if (tile.tile_index >= header.tile_count) return "tile_index is not below tile_count";
  if (tile.column_count > kTileSide || tile.row_count > kTileSide) return "the tile is too large";
  if (!is_inside(tile.first_column, tile.column_count, header.column_count) ||
      !is_inside(tile.first_row, tile.row_count, header.row_count)) {
    return "the tile is outside its submap";
  }
  const std::uint32_t cells = tile.column_count * tile.row_count;
  if (tile.so_log_odds_plus_128._length != cells || tile.mo_evidence._length != cells)
    return "the tile's grids have a wrong size";
  if (!is_inside(tile.first_surfel, tile.surfels._length, header.surfel_count))
    return "surfels are outside their list";
  for (const slammot_Surfel& surfel : elements(tile.surfels)) {
    if (!is_sound(surfel.x_m) || !is_sound(surfel.y_m) || !is_sound(surfel.normal_x) ||
        !is_sound(surfel.normal_y) || !is_amount(surfel.weight)) {
      return "a surfel is not finite";
    }
  }
  return fault_of_measurements(tile);
}

void copy_measurements_into(flow::Submap& submap, const slammot_SubmapTile& tile) {
  for (const slammot_SubmapFix& fix : elements(tile.fixes)) {
    submap.fixes.push_back({fix.x_m,
                            fix.y_m,
                            {fix.latitude_deg, fix.longitude_deg},
                            fix.east_variance_m2,
                            fix.north_variance_m2,
                            fix.covariance_m2});
  }
  for (const slammot_SubmapHeading& heading : elements(tile.headings))
    submap.headings.push_back({heading.in_submap_rad, heading.from_east_rad, heading.sigma_rad});
}

/// Copies the tile's rectangle and its stretch of surfels to where they belong.
void copy_into(flow::Submap& submap, const slammot_SubmapTile& tile) {
  for (std::uint32_t row = 0; row < tile.row_count; ++row) {
    const std::size_t from = std::size_t{row} * tile.column_count;
    const std::size_t to = (std::size_t{tile.first_row} + row) * submap.columns + tile.first_column;
    std::transform(tile.so_log_odds_plus_128._buffer + from,
                   tile.so_log_odds_plus_128._buffer + from + tile.column_count,
                   submap.so_log_odds.begin() + to,
                   [](std::uint8_t plus_128) { return static_cast<std::int8_t>(plus_128 - 128); });
    std::copy_n(tile.mo_evidence._buffer + from, tile.column_count,
                submap.mo_evidence.begin() + to);
  }
  auto next = submap.surfels.begin() + tile.first_surfel;
  for (const slammot_Surfel& surfel : elements(tile.surfels)) {
    *next++ = {surfel.x_m, surfel.y_m, surfel.normal_x, surfel.normal_y, surfel.weight};
  }
  if (tile.tile_index == 0) copy_measurements_into(submap, tile);
}

}  // namespace

std::uint64_t content_hash(const flow::Submap& submap) {
  Fnv1a hash;
  hash.add(submap.map_id.value);
  hash.add(submap.first_stamp_ns);
  hash.add(submap.last_stamp_ns);
  hash.add(submap.odom_from_submap);
  hash.add(submap.previous_from_submap.pose);
  hash.add_all(std::span<const double>(submap.previous_from_submap.covariance.data(), 9));
  hash.add(submap.submap_from_base_at_end);
  hash.add(submap.travelled_m);
  hash.add(submap.cell_size_m);
  hash.add(submap.min_x_m);
  hash.add(submap.min_y_m);
  hash.add(submap.columns);
  hash.add(submap.rows);
  hash.add(submap.saliency);
  hash.add_all(std::span<const std::int8_t>(submap.so_log_odds));
  hash.add_all(std::span<const std::uint8_t>(submap.mo_evidence));
  for (const flow::Surfel& surfel : submap.surfels) {
    hash.add(surfel.x_m);
    hash.add(surfel.y_m);
    hash.add(surfel.normal_x);
    hash.add(surfel.normal_y);
    hash.add(surfel.weight);
  }
  for (const flow::SubmapFix& fix : submap.fixes) {
    for (const double number : {fix.position.latitude_deg, fix.position.longitude_deg})
      hash.add(number);
    for (const float number :
         {fix.x_m, fix.y_m, fix.east_variance_m2, fix.north_variance_m2, fix.covariance_m2})
      hash.add(number);
  }
  for (const flow::SubmapHeading& heading : submap.headings) {
    for (const float number : {heading.in_submap_rad, heading.from_east_rad, heading.sigma_rad})
      hash.add(number);
  }
  return hash.hash();
}

void SubmapEncoder::find_rectangles(const flow::Submap& submap) {
  rectangles_.clear();
  const auto is_seen = [&](const Rectangle& rectangle) {
    const auto is_zero = [](auto cell) { return cell == 0; };
    for (std::uint32_t row = 0; row < rectangle.rows; ++row) {
      const std::size_t first =
          std::size_t{rectangle.first_row + row} * submap.columns + rectangle.first_column;
      const auto so = submap.so_log_odds.begin() + first;
      const auto mo = submap.mo_evidence.begin() + first;
      if (!std::all_of(so, so + rectangle.columns, is_zero) ||
          !std::all_of(mo, mo + rectangle.columns, is_zero))
        return true;
    }
    return false;
  };
  for (std::uint32_t row = 0; row < submap.rows; row += kTileSide) {
    for (std::uint32_t column = 0; column < submap.columns; column += kTileSide) {
      const Rectangle rectangle{column, row, std::min(kTileSide, submap.columns - column),
                                std::min(kTileSide, submap.rows - row)};
      if (is_seen(rectangle)) rectangles_.push_back(rectangle);
    }
  }
}

void SubmapEncoder::fill_rectangle(const flow::Submap& submap, const Rectangle& rectangle) {
  so_log_odds_plus_128_.clear();
  mo_evidence_.clear();
  for (std::uint32_t row = 0; row < rectangle.rows; ++row) {
    const std::size_t first =
        std::size_t{rectangle.first_row + row} * submap.columns + rectangle.first_column;
    const auto so = submap.so_log_odds.begin() + first;
    const auto mo = submap.mo_evidence.begin() + first;
    std::transform(so, so + rectangle.columns, std::back_inserter(so_log_odds_plus_128_),
                   [](std::int8_t log_odds) { return static_cast<std::uint8_t>(log_odds + 128); });
    mo_evidence_.insert(mo_evidence_.end(), mo, mo + rectangle.columns);
  }
  sample_.first_column = rectangle.first_column;
  sample_.first_row = rectangle.first_row;
  sample_.column_count = rectangle.columns;
  sample_.row_count = rectangle.rows;
  show(sample_.so_log_odds_plus_128, so_log_odds_plus_128_);
  show(sample_.mo_evidence, mo_evidence_);
}

void SubmapEncoder::fill_surfels(const flow::Submap& submap, std::uint32_t first,
                                 std::uint32_t end) {
  surfels_.clear();
  for (std::uint32_t i = first; i < end; ++i) {
    const flow::Surfel& surfel = submap.surfels[i];
    surfels_.push_back({surfel.x_m, surfel.y_m, surfel.normal_x, surfel.normal_y, surfel.weight});
  }
  sample_.first_surfel = first;
  show(sample_.surfels, surfels_);
}

void SubmapEncoder::fill_measurements(const flow::Submap& submap, std::uint32_t tile) {
  fixes_.clear();
  headings_.clear();
  if (tile == 0) {
    for (const flow::SubmapFix& fix : submap.fixes)
      fixes_.push_back({fix.position.latitude_deg, fix.position.longitude_deg, fix.x_m, fix.y_m,
                        fix.east_variance_m2, fix.north_variance_m2, fix.covariance_m2});
    for (const flow::SubmapHeading& heading : submap.headings)
      headings_.push_back({heading.in_submap_rad, heading.from_east_rad, heading.sigma_rad});
  }
  show(sample_.fixes, fixes_);
  show(sample_.headings, headings_);
}

void SubmapEncoder::encode(std::string_view vehicle_id, const flow::Submap& submap,
                           const std::function<void(const slammot_SubmapTile&)>& write) {
  const std::uint64_t cells = std::uint64_t{submap.columns} * submap.rows;
  if (cells > kMostCells || submap.surfels.size() > kMostSurfels ||
      submap.fixes.size() > flow::kMostFixesOfSubmap ||
      submap.headings.size() > flow::kMostHeadingsOfSubmap) {
    throw std::length_error("submap " + std::to_string(submap.submap_id.value) +
                            " is too large for the bus");
  }
  if (submap.so_log_odds.size() != cells || submap.mo_evidence.size() != cells) {
    throw std::invalid_argument("submap " + std::to_string(submap.submap_id.value) +
                                ": grids are not columns x rows");
  }
  find_rectangles(submap);
  const auto surfels = static_cast<std::uint32_t>(submap.surfels.size());
  const std::uint32_t tiles = std::max(
      {static_cast<std::uint32_t>(rectangles_.size()), divide_up(surfels, kMostSurfelsOfTile), 1U});
  const std::uint32_t surfels_of_tile = divide_up(surfels, tiles);
  set_text(sample_.vehicle_id, vehicle_id);
  sample_.submap_id = submap.submap_id.value;
  sample_.header = encode_header(submap, tiles);
  for (std::uint32_t tile = 0; tile < tiles; ++tile) {
    sample_.tile_index = tile;
    fill_rectangle(submap, tile < rectangles_.size() ? rectangles_[tile] : Rectangle{});
    fill_surfels(submap, std::min(surfels, tile * surfels_of_tile),
                 std::min(surfels, (tile + 1) * surfels_of_tile));
    fill_measurements(submap, tile);
    write(sample_);
  }
}

SubmapAssembler::Partial& SubmapAssembler::partial_of(const slammot_SubmapTile& tile) {
  const flow::SubmapId submap_id{tile.submap_id};
  const auto known = partial_.find(submap_id);
  if (known != partial_.end()) {
    if (known->second.header.content_hash == tile.header.content_hash) return known->second;
    partial_.erase(known);
    ++counters_.replaced_submaps;
  }
  if (partial_.size() == kMostIncompleteSubmaps) partial_.erase(partial_.begin());
  const std::uint32_t tiles = tile.header.tile_count;
  Partial partial{tile.header, std::vector<bool>(tiles, false), tiles,
                  empty_submap(submap_id, tile.header)};
  return partial_.emplace(submap_id, std::move(partial)).first->second;
}

SubmapAssembler::Added SubmapAssembler::complete(flow::SubmapId submap_id) {
  auto partial = partial_.extract(submap_id);
  const std::uint64_t hash = partial.mapped().header.content_hash;
  if (content_hash(partial.mapped().submap) != hash) {
    ++counters_.faulty_tiles;
    return {std::nullopt, 0, "the tiles do not add up to the submap that was sent"};
  }
  content_hash_of_complete_[submap_id] = hash;
  return {std::move(partial.mapped().submap), hash, ""};
}

SubmapAssembler::Added SubmapAssembler::add(const slammot_SubmapTile& tile) {
  ++counters_.tiles;
  if (const std::string_view fault = fault_of(tile); !fault.empty()) {
    ++counters_.faulty_tiles;
    return {std::nullopt, 0, fault};
  }
  const flow::SubmapId submap_id{tile.submap_id};
  const auto complete_one = content_hash_of_complete_.find(submap_id);
  if (complete_one != content_hash_of_complete_.end() &&
      complete_one->second == tile.header.content_hash) {
    ++counters_.repeated_tiles;
    return {};
  }
  Partial& partial = partial_of(tile);
  // The hash identifies the version, but a sender may be wrong: the allocated size counts.
  if (partial.has_tile.size() != tile.header.tile_count ||
      partial.submap.columns != tile.header.column_count ||
      partial.submap.rows != tile.header.row_count ||
      partial.submap.surfels.size() != tile.header.surfel_count) {
    ++counters_.faulty_tiles;
    return {std::nullopt, 0, "the tile's header is not that of its submap's other tiles"};
  }
  if (partial.has_tile[tile.tile_index]) {
    ++counters_.repeated_tiles;
    return {};
  }
  copy_into(partial.submap, tile);
  partial.has_tile[tile.tile_index] = true;
  if (--partial.missing_tiles > 0) return {};
  return complete(submap_id);
}

}  // namespace slammot::wire
