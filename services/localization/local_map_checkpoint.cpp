// LocalMap as bytes of a checkpoint.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "services/localization/local_map.hpp"
#include "services/localization/local_map_windows.hpp"

namespace slammot::localization {
namespace {

using geometry::Vector2;

struct StoredMap {
  grids::GridWindow window;
  std::vector<std::int8_t> so;
  std::vector<std::uint8_t> mo;
  std::vector<std::int8_t> lasting;
  std::vector<std::int8_t> inherited_so;
  std::vector<std::uint8_t> inherited_mo;
  std::vector<std::int8_t> inherited_lasting;
  grids::GridWindow surfel_lattice;
  std::vector<grids::SurfelMoments> surfels;
  std::vector<grids::SurfelMoments> inherited_surfels;
};

StoredMap stored_map_of(ByteReader& from, std::size_t most_cells) {
  StoredMap stored;
  from.get(stored.window);
  from.get_cells(stored.so, most_cells);
  from.get_cells(stored.mo, most_cells);
  from.get_cells(stored.lasting, most_cells);
  from.get_cells(stored.inherited_so, most_cells);
  from.get_cells(stored.inherited_mo, most_cells);
  from.get_cells(stored.inherited_lasting, most_cells);
  from.get(stored.surfel_lattice);
  from.get_all(stored.surfels);
  from.get_all(stored.inherited_surfels);
  return stored;
}

/// Same shape, and on the lattice where no index can overflow.
bool is_like(const grids::GridWindow& window, const grids::GridWindow& expected) {
  constexpr std::int64_t kFarthest = std::int64_t{1} << 30;
  const auto is_near = [](std::int64_t place) { return std::abs(place) < kFarthest; };
  return window.cell_size_m == expected.cell_size_m && window.columns == expected.columns &&
         window.rows == expected.rows && is_near(window.first.column) && is_near(window.first.row);
}

/// True if these can be the moments of echoes in one cell.
bool is_possible(const grids::CellMoments& moments, double cell_size_m) {
  const double farthest_m = cell_size_m * static_cast<double>(moments.weight);
  return moments.weight > 0.0F && std::isfinite(moments.weight) &&
         std::abs(moments.x) <= farthest_m && std::abs(moments.y) <= farthest_m &&
         std::isfinite(moments.xx) && std::isfinite(moments.xy) && std::isfinite(moments.yy) &&
         std::isfinite(moments.own_echoes) && std::isfinite(moments.first_seen_at_m) &&
         std::isfinite(moments.last_seen_at_m);
}

/// True if this can be a map of the configuration.
bool is_possible(const StoredMap& stored, const LocalMapConfig& config) {
  const auto is_of_map = [&](const auto& cells) {
    return cells.size() == stored.window.cell_count();
  };
  const auto are_of_surfels = [&](const std::vector<grids::SurfelMoments>& surfels) {
    return std::ranges::all_of(surfels, [&](const grids::SurfelMoments& one) {
      return is_possible(one.moments, config.surfel_size_m);
    });
  };
  return is_like(stored.window, evidence_window(config, {0.0, 0.0})) &&
         is_like(stored.surfel_lattice, surfel_window(config, {0.0, 0.0})) &&
         is_of_map(stored.so) && is_of_map(stored.mo) && is_of_map(stored.lasting) &&
         is_of_map(stored.inherited_so) && is_of_map(stored.inherited_mo) &&
         is_of_map(stored.inherited_lasting) && are_of_surfels(stored.surfels) &&
         are_of_surfels(stored.inherited_surfels);
}

void set_surfels(grids::SurfelMap& map, const std::vector<grids::SurfelMoments>& surfels) {
  for (const grids::SurfelMoments& surfel : surfels) map.set_moments(surfel.cell, surfel.moments);
}

}  // namespace

LocalMap::Snapshot LocalMap::snapshot(Snapshot memory) const {
  memory.window_ = evidence().window();
  memory.so_ = evidence().so_cells();
  memory.mo_ = evidence().mo_cells();
  memory.lasting_ = evidence().lasting_cells();
  memory.surfel_window_ = surfels_.window();
  memory.surfels_ = surfels_.all_moments(std::move(memory.surfels_));
  memory.inherited_ = inherited_;
  memory.submap_id_ = submap_id_;
  memory.odom_from_submap_ = odom_from_submap_;
  memory.progress_ = progress_;
  memory.odometer_ = odometer_;
  return memory;
}

void LocalMap::Snapshot::write(std::vector<std::byte>& bytes) const {
  put(bytes, window_);
  put_cells(bytes, so_);
  put_cells(bytes, mo_);
  put_cells(bytes, lasting_);
  put_cells(bytes, inherited_->so);
  put_cells(bytes, inherited_->mo);
  put_cells(bytes, inherited_->lasting);
  put(bytes, surfel_window_);
  put_all(bytes, surfels_);
  put_all(bytes, inherited_->surfels.all_moments());
  put(bytes, submap_id_);
  put(bytes, odom_from_submap_);
  put(bytes, progress_.first_stamp_ns);
  put(bytes, progress_.last_stamp_ns);
  put(bytes, progress_.scans);
  put(bytes, odometer_.way_m);
  put(bytes, odometer_.counted_to_m.has_value());
  put(bytes, odometer_.counted_to_m.value_or(Vector2::Zero()));
}

std::optional<LocalMap> LocalMap::restored(const LocalMapConfig& config, ByteReader& from,
                                           work::SideWork* help) {
  StoredMap stored = stored_map_of(from, evidence_window(config, {0.0, 0.0}).cell_count());
  flow::SubmapId submap_id;
  geometry::Pose2 odom_from_submap;
  Progress progress;
  Odometer odometer;
  bool has_counted = false;
  Vector2 counted_to_m = Vector2::Zero();
  from.get(submap_id);
  from.get(odom_from_submap);
  from.get(progress.first_stamp_ns);
  from.get(progress.last_stamp_ns);
  from.get(progress.scans);
  from.get(odometer.way_m);
  from.get(has_counted);
  from.get(counted_to_m);
  if (has_counted) odometer.counted_to_m = counted_to_m;
  const bool fits = from.ok() && is_possible(stored, config) && is_believable(odom_from_submap) &&
                    odometer.way_m >= 0.0 && std::isfinite(odometer.way_m) &&
                    is_believable(counted_to_m);
  if (!fits) return std::nullopt;
  LocalMap map(config, stored.window, stored.surfel_lattice, help);
  Inherited inherited{std::move(stored.inherited_so), std::move(stored.inherited_mo),
                      std::move(stored.inherited_lasting), map.surfels_};
  map.evidence_.grid().set_cells(std::move(stored.so), std::move(stored.mo),
                                 std::move(stored.lasting));
  set_surfels(map.surfels_, stored.surfels);
  set_surfels(inherited.surfels, stored.inherited_surfels);
  map.inherited_ = std::make_shared<const Inherited>(std::move(inherited));
  map.submap_id_ = submap_id;
  map.odom_from_submap_ = odom_from_submap;
  map.progress_ = progress;
  map.odometer_ = odometer;
  return map;
}

}  // namespace slammot::localization
