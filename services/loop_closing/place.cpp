#include "services/loop_closing/place.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/order_statistics.hpp"

namespace slammot::loop_closing {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kLeastEchoes = 2.0;      // Surfels with fewer echoes are ignored.
constexpr double kOccupiedLogOdds = 0.8;  // Least log-odds of an occupied cell.
constexpr double kFreeLogOdds = 0.8;      // Least negative log-odds of a free cell.

constexpr double kStepsPerLogOdds = 16.0;  // Scale of flow::Submap::so_log_odds.

std::int8_t steps_of(double log_odds) {
  return static_cast<std::int8_t>(std::clamp(std::lround(kStepsPerLogOdds * log_odds), 1L, 127L));
}

void mark_around(CellStates& cells, std::int32_t column, std::int32_t row, std::int32_t radius) {
  for (std::int32_t y = std::max(row - radius, 0); y <= std::min(row + radius, cells.rows() - 1);
       ++y) {
    for (std::int32_t x = std::max(column - radius, 0);
         x <= std::min(column + radius, cells.columns() - 1); ++x)
      cells.set(x, y, CellState::kOccupied);
  }
}

/// Calls take(column, row) for the cells of which holds(log-odds) is true.
template <typename Holds, typename Take>
void for_each_cell(const flow::Submap& submap, Holds holds, Take take) {
  std::size_t i = 0;
  for (std::int32_t row = 0; row < static_cast<std::int32_t>(submap.rows); ++row) {
    for (std::int32_t column = 0; column < static_cast<std::int32_t>(submap.columns); ++column) {
      if (holds(submap.so_log_odds[i++])) take(column, row);
    }
  }
}

CellStates cells_of(const flow::Submap& submap, const PlaceConfig& config) {
  const std::int8_t occupied = steps_of(kOccupiedLogOdds);
  const std::int8_t free = steps_of(kFreeLogOdds);
  const auto radius =
      static_cast<std::int32_t>(std::lround(config.tolerance_m / submap.cell_size_m));
  CellStates cells(static_cast<std::int32_t>(submap.columns),
                   static_cast<std::int32_t>(submap.rows));
  for_each_cell(
      submap, [free](std::int8_t log_odds) { return log_odds <= -free; },
      [&](std::int32_t column, std::int32_t row) { cells.set(column, row, CellState::kFree); });
  for_each_cell(
      submap, [occupied](std::int8_t log_odds) { return log_odds >= occupied; },
      [&](std::int32_t column, std::int32_t row) { mark_around(cells, column, row, radius); });
  cells.share_blocks();  // kept as long as the map
  return cells;
}

/// State over all members; occupied outweighs free, free outweighs unknown.
CellState state_in(const Target& target, const Vector2& point_in_target_m) {
  CellState state = CellState::kUnknown;
  for (const Target::Member& member : target.members) {
    state = std::max(state, member.place->state_at(geometry::inverse(member.target_from_member) *
                                                   point_in_target_m));
  }
  return state;
}

/// Median of latitude and longitude: an error that lasts for less than half of the submap does not
/// move it.
std::optional<geometry::Geodetic> median_fix(const std::vector<flow::SubmapFix>& fixes) {
  constexpr std::size_t kFewest = 5;
  if (fixes.size() < kFewest) return std::nullopt;
  std::vector<double> latitudes_deg;
  std::vector<double> longitudes_deg;
  for (const flow::SubmapFix& fix : fixes) {
    latitudes_deg.push_back(fix.position.latitude_deg);
    longitudes_deg.push_back(fix.position.longitude_deg);
  }
  return geometry::Geodetic{geometry::upper_median_in_place(latitudes_deg),
                            geometry::upper_median_in_place(longitudes_deg)};
}

void count(CellState state, Agreement& agreement) {
  if (state == CellState::kOccupied) ++agreement.occupied_in_both;
  if (state == CellState::kFree) ++agreement.contradicted;
}

}  // namespace

CellState Place::state_at(const Vector2& point_in_submap_m) const {
  const double column = std::floor((point_in_submap_m.x() - min_x_m) / cell_size_m);
  const double row = std::floor((point_in_submap_m.y() - min_y_m) / cell_size_m);
  if (!(column >= 0.0 && column < cells.columns() && row >= 0.0 && row < cells.rows()))
    return CellState::kUnknown;
  return cells.at(static_cast<std::int32_t>(column), static_cast<std::int32_t>(row));
}

Place make_place(const flow::Submap& submap, double travelled_before_m, const PlaceConfig& config) {
  Place place;
  place.id = submap.submap_id;
  place.travelled_before_m = travelled_before_m;
  place.travelled_after_m = travelled_before_m + submap.travelled_m;
  place.odom_from_submap = submap.odom_from_submap;
  place.by_gnss = median_fix(submap.fixes);
  place.centre_m = 0.5 * submap.submap_from_base_at_end.translation_m();
  place.cell_size_m = submap.cell_size_m;
  place.min_x_m = submap.min_x_m;
  place.min_y_m = submap.min_y_m;
  place.cells = cells_of(submap, config);
  for (const flow::Surfel& surfel : submap.surfels) {
    // A surfel in free space was seen through later: it is no wall.
    if (surfel.weight < kLeastEchoes ||
        place.state_at({surfel.x_m, surfel.y_m}) == CellState::kFree)
      continue;
    place.surfels.push_back(surfel);
  }
  place.surfels.shrink_to_fit();  // kept as long as the map
  return place;
}

void supersede(Place& place) {
  place.is_superseded = true;
  place.surfels = {};
  place.cells = {};
}

std::vector<flow::Surfel> surfels_in_target(const Target& target) {
  std::vector<flow::Surfel> surfels;
  for (const Target::Member& member : target.members) {
    const Eigen::Matrix2d turn = geometry::rotation(member.target_from_member.heading_rad);
    for (const flow::Surfel& surfel : member.place->surfels) {
      const Vector2 at =
          turn * Vector2(surfel.x_m, surfel.y_m) + member.target_from_member.translation_m();
      const Vector2 normal = turn * Vector2(surfel.normal_x, surfel.normal_y);
      surfels.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()),
                         static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                         surfel.weight});
    }
  }
  return surfels;
}

Agreement compare(const Target& target, const Place& source, const Pose2& target_from_source) {
  Agreement agreement;
  for (const flow::Surfel& surfel : source.surfels) {
    count(state_in(target, target_from_source * Vector2(surfel.x_m, surfel.y_m)), agreement);
  }
  agreement.source_in_target = agreement.occupied_in_both;
  agreement.source_walls = static_cast<int>(source.surfels.size());
  for (const Target::Member& member : target.members) {
    const Pose2 source_from_member =
        geometry::inverse(target_from_source) * member.target_from_member;
    for (const flow::Surfel& surfel : member.place->surfels) {
      count(source.state_at(source_from_member * Vector2(surfel.x_m, surfel.y_m)), agreement);
    }
  }
  return agreement;
}

}  // namespace slammot::loop_closing
