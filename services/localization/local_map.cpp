#include "services/localization/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace slammot::localization {
namespace {

using geometry::Vector2;

constexpr double kSurfelWeightLimit = 1000.0;  // Echoes after which a surfel's mean becomes a
                                               // running one.

constexpr std::uint32_t kScansBetweenCleanings = 10;
constexpr double kInheritedShareOfLimit = 0.75;

grids::GridWindow evidence_window(const LocalMapConfig& config, const Vector2& centre_m) {
  return grids::window_around(centre_m, config.side_m, config.cell_size_m);
}

grids::GridWindow surfel_window(const LocalMapConfig& config, const Vector2& centre_m) {
  return grids::window_around(centre_m, config.side_m, config.surfel_size_m);
}

int free_steps(const LocalMapConfig& config) {
  return grids::steps_of_log_odds(config.free_log_odds);
}

int end_cell_tolerance(const LocalMapConfig& config) {
  return static_cast<int>(std::ceil(config.end_cell_tolerance_m / config.cell_size_m - 0.5));
}

geometry::Pose2 pose_of_window(const grids::GridWindow& window) {
  const Vector2 centre_m = window.centre_of(
      {window.first.column + window.columns / 2, window.first.row + window.rows / 2});
  return {centre_m.x(), centre_m.y(), 0.0};
}

/// Evidence of one window, row-major.
struct Cells {
  const std::vector<std::int8_t>& so;
  const std::vector<std::uint8_t>& mo;
};

/// Smallest window that holds every cell in which something was seen since. Whole rows in which
/// nothing was are most of them.
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

// By plain pointers: elements of vectors of bytes might be the vectors themselves, for all a
// compiler knows, and are then not taken many at a time.

/// What the submap itself saw, of what is now and what it took over.
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

/// What has changed of a cell, within so many steps. In a loop no cell needs a branch.
std::int8_t changed(std::int8_t now, std::int8_t before, std::int8_t most_steps) {
  const auto least_steps = static_cast<std::int8_t>(-most_steps);
  const std::int8_t raised = now < least_steps ? least_steps : now;
  const std::int8_t limited = raised > most_steps ? most_steps : raised;
  return now != before ? limited : std::int8_t{0};
}

void keep_changed(std::int8_t* now, const std::int8_t* before, std::size_t count, int most_steps) {
  const auto most = static_cast<std::int8_t>(most_steps);
  for (std::size_t i = 0; i < count; ++i) now[i] = changed(now[i], before[i], most);
}

/// The same of evidence that lasts, and what was driven over.
void keep_changed_or_driven_over(std::int8_t* now, const std::int8_t* before, std::size_t count,
                                 int most_steps) {
  const auto most = static_cast<std::int8_t>(most_steps);
  for (std::size_t i = 0; i < count; ++i)
    now[i] =
        grids::LastingEvidence::is_driven_over(now[i]) ? now[i] : changed(now[i], before[i], most);
}

struct StoredSurfel {
  grids::Cell cell;
  grids::CellMoments moments;
};

void put_surfels(std::vector<std::byte>& bytes, const grids::SurfelMap& map) {
  std::vector<StoredSurfel> surfels;
  for (const grids::SurfelView& surfel : map.all())
    surfels.push_back({surfel.cell, *map.moments_at(surfel.cell)});
  put_all(bytes, surfels);
}

std::vector<StoredSurfel> get_surfels(ByteReader& from) {
  std::vector<StoredSurfel> surfels;
  from.get_all(surfels);
  return surfels;
}

/// Same shape, and somewhere on the lattice where no index can overflow.
bool is_like(const grids::GridWindow& window, const grids::GridWindow& expected) {
  constexpr std::int64_t kFarthest = std::int64_t{1} << 30;
  const auto is_near = [](std::int64_t place) { return std::abs(place) < kFarthest; };
  return window.cell_size_m == expected.cell_size_m && window.columns == expected.columns &&
         window.rows == expected.rows && is_near(window.first.column) && is_near(window.first.row);
}

/// Whether these can be the moments of echoes in one cell.
bool is_possible(const grids::CellMoments& moments, double cell_size_m) {
  const double farthest_m = cell_size_m * static_cast<double>(moments.weight);
  return moments.weight > 0.0F && std::isfinite(moments.weight) &&
         std::abs(moments.x) <= farthest_m && std::abs(moments.y) <= farthest_m &&
         std::isfinite(moments.xx) && std::isfinite(moments.xy) && std::isfinite(moments.yy) &&
         std::isfinite(moments.own_echoes) && std::isfinite(moments.first_seen_at_m) &&
         std::isfinite(moments.last_seen_at_m);
}

}  // namespace

LocalMap::LocalMap(const LocalMapConfig& config, const Vector2& centre_in_odom_m,
                   work::SideWork* help, flow::SubmapId first)
    : config_(config),
      free_steps_(free_steps(config)),
      end_cell_tolerance_(end_cell_tolerance(config)),
      evidence_(grids::EvidenceGrid(evidence_window(config, centre_in_odom_m), config.evidence,
                                    config.lasting),
                help),
      surfels_(surfel_window(config, centre_in_odom_m), kSurfelWeightLimit),
      inherited_so_(evidence().so_cells()),
      inherited_mo_(evidence().mo_cells()),
      inherited_lasting_(evidence().lasting_cells()),
      inherited_surfels_(surfels_),
      submap_id_(first),
      odom_from_submap_(pose_of_window(evidence().window())) {}

Vector2 LocalMap::window_centre_m() const { return odom_from_submap_.translation_m(); }

void LocalMap::prepare(const Vector2& origin_m, const std::vector<grids::Ray>& rays,
                       double beam_step_rad) {
  evidence_.prepare(origin_m, rays, beam_step_rad);
}

void LocalMap::integrate(std::int64_t stamp_ns, const Vector2& origin_m,
                         const std::vector<grids::Ray>& rays, double beam_step_rad) {
  if (scans_ == 0) first_stamp_ns_ = stamp_ns;
  count_way(origin_m);
  last_stamp_ns_ = stamp_ns;
  ++scans_;
  evidence_.integrate(origin_m, rays, beam_step_rad);
  stationary_m_.clear();
  for (const grids::Ray& ray : rays) {
    if (ray.echo == grids::Echo::kStationary) stationary_m_.push_back(ray.end_m);
  }
  surfels_.add_all(stationary_m_, odometer_m_);
  if (scans_ % kScansBetweenCleanings == 0) forget_surfels_in_free_space();
}

void LocalMap::count_way(const Vector2& origin_m) {
  constexpr double kMoreThanJitter_m = 0.1;
  const double way_m = counted_to_m_ ? (origin_m - *counted_to_m_).norm() : 0.0;
  if (counted_to_m_ && way_m < kMoreThanJitter_m) return;
  odometer_m_ += way_m;
  counted_to_m_ = origin_m;
}

void LocalMap::forget_surfels_in_free_space() {
  const grids::EvidenceGrid& evidence = evidence_.grid();
  surfels_.erase_where(
      [&](const Vector2& mean_m) {
        const grids::Cell cell = evidence.window().cell_at(mean_m.x(), mean_m.y());
        return evidence.so_steps(cell) <= -free_steps_ &&
               evidence.highest_so_steps(cell, 1) <= -free_steps_;  // the first tells of nearly all
      },
      evidence_.help());
}

void LocalMap::restore_stationary(const Vector2& point_in_odom_m, grids::Echo integrated_as) {
  evidence_.restore_stationary(point_in_odom_m, integrated_as);
  surfels_.add(point_in_odom_m, odometer_m_);
}

float LocalMap::expected_range_m(const Vector2& origin_in_odom_m, const Vector2& towards_in_odom_m,
                                 double max_range_m) const {
  const Vector2 way_m = towards_in_odom_m - origin_in_odom_m;
  if (way_m == Vector2::Zero())
    return static_cast<float>(max_range_m);  // an echo at the scanner itself lies in no direction
  return static_cast<float>(
      evidence_.grid().distance_to_occupied(origin_in_odom_m, way_m.normalized(), max_range_m));
}

void LocalMap::look_up_end(const Vector2& end_in_odom_m, flow::LocalizedBeam& beam) const {
  const grids::EvidenceGrid& evidence = evidence_.grid();
  const grids::Cell cell = evidence.window().cell_at(end_in_odom_m.x(), end_in_odom_m.y());
  const int so_steps = evidence.so_steps(cell);
  beam.free_evidence = static_cast<float>(-so_steps * grids::kLogOddsStep);
  beam.moving_evidence = static_cast<float>(evidence.moving(cell)) / 255.0F;
  if (evidence.is_occupied_near(cell, end_cell_tolerance_)) {
    beam.end_cell = flow::EndCell::kOccupied;
  } else {
    const bool is_free = so_steps <= -free_steps_;
    beam.end_cell = is_free ? flow::EndCell::kFree : flow::EndCell::kUnseen;
  }
}

bool LocalMap::is_outgrown(const Vector2& position_in_odom_m, double travelled_m) const {
  return travelled_m >= config_.new_map_after_travel_m ||
         (position_in_odom_m - window_centre_m()).norm() >= config_.new_map_after_m;
}

flow::Submap LocalMap::submap() const {
  const grids::EvidenceGrid& evidence = evidence_.grid();
  const grids::GridWindow& window = evidence.window();
  const std::vector<std::int8_t>& lasting = evidence.lasting_cells();
  const std::vector<std::uint8_t>& mo = evidence.mo_cells();
  const grids::GridWindow bounds =
      bounds_of_seen(window, {lasting, mo}, {inherited_lasting_, inherited_mo_});
  flow::Submap submap;
  submap.submap_id = submap_id_;
  submap.first_stamp_ns = first_stamp_ns_;
  submap.last_stamp_ns = last_stamp_ns_;
  submap.odom_from_submap = odom_from_submap_;
  submap.cell_size_m = window.cell_size_m;
  submap.min_x_m = bounds.first.column * window.cell_size_m - odom_from_submap_.x_m;
  submap.min_y_m = bounds.first.row * window.cell_size_m - odom_from_submap_.y_m;
  submap.columns = static_cast<std::uint32_t>(bounds.columns);
  submap.rows = static_cast<std::uint32_t>(bounds.rows);
  submap.so_log_odds.resize(bounds.cell_count());
  submap.mo_evidence.resize(bounds.cell_count());
  for (std::int32_t row = 0; row < bounds.rows; ++row) {
    const std::size_t from = window.index({bounds.first.column, bounds.first.row + row});
    const std::ptrdiff_t to = std::ptrdiff_t{row} * bounds.columns;
    put_own_so(lasting.data() + from, inherited_lasting_.data() + from, bounds.columns,
               submap.so_log_odds.data() + to);
    put_own_mo(mo.data() + from, inherited_mo_.data() + from, bounds.columns,
               submap.mo_evidence.data() + to);
  }
  std::vector<grids::SurfelView> surfels = surfels_.all();
  // By place: the order in which they were first seen is another after a restart.
  std::sort(surfels.begin(), surfels.end(),
            [](const grids::SurfelView& a, const grids::SurfelView& b) {
              return std::pair(a.cell.row, a.cell.column) < std::pair(b.cell.row, b.cell.column);
            });
  for (const grids::SurfelView& surfel : surfels) {
    if (const auto own = own_surfel(surfel)) submap.surfels.push_back(*own);
  }
  return submap;
}

std::optional<flow::Surfel> LocalMap::own_surfel(const grids::SurfelView& surfel) const {
  if (surfel.own_echoes <= 0.0) return std::nullopt;
  const grids::CellMoments& all = *surfels_.moments_at(surfel.cell);
  const grids::CellMoments* inherited = inherited_surfels_.moments_at(surfel.cell);
  Vector2 mean_m = surfel.mean_m;
  // A cell that was erased or became a running mean since can no longer be told apart.
  if (inherited != nullptr && std::abs(all.weight - inherited->weight - all.own_echoes) < 0.5F) {
    mean_m = surfels_.window().centre_of(surfel.cell) +
             Vector2(all.x - inherited->x, all.y - inherited->y) / all.own_echoes;
  }
  const Vector2 at_m = mean_m - odom_from_submap_.translation_m();
  return flow::Surfel{static_cast<float>(at_m.x()), static_cast<float>(at_m.y()),
                      static_cast<float>(surfel.normal.x()), static_cast<float>(surfel.normal.y()),
                      static_cast<float>(surfel.own_echoes)};
}

void LocalMap::leave_behind_what_was_not_seen() {
  // Short of the limit, so that whatever the next submap sees moves the cell and can be told from
  // what it took over.
  const int most_steps = std::min(
      127, grids::steps_of_log_odds(kInheritedShareOfLimit * config_.evidence.limit_log_odds));
  std::vector<std::int8_t> so = evidence().so_cells();
  keep_changed(so.data(), inherited_so_.data(), so.size(), most_steps);
  std::vector<std::int8_t> lasting = evidence().lasting_cells();
  keep_changed_or_driven_over(
      lasting.data(), inherited_lasting_.data(), lasting.size(),
      grids::steps_of_log_odds(kInheritedShareOfLimit * config_.lasting.limit_log_odds));
  evidence_.grid().set_cells(std::move(so), evidence().mo_cells(), std::move(lasting));
  for (const grids::SurfelView& surfel : surfels_.all()) {
    if (surfel.own_echoes <= 0.0) surfels_.erase(surfel.cell);
  }
}

void LocalMap::begin_next(const Vector2& centre_in_odom_m) {
  leave_behind_what_was_not_seen();
  evidence_.grid() = evidence().moved_to(evidence_window(config_, centre_in_odom_m));
  surfels_ = surfels_.moved_to(surfel_window(config_, centre_in_odom_m));
  inherited_so_ = evidence().so_cells();
  inherited_mo_ = evidence().mo_cells();
  inherited_lasting_ = evidence().lasting_cells();
  inherited_surfels_ = surfels_;
  odom_from_submap_ = pose_of_window(evidence().window());
  ++submap_id_.value;
  scans_ = 0;
}

void LocalMap::begin_astray(const Vector2& centre_in_odom_m) {
  const flow::SubmapId next{submap_id_.value + (has_echoes() ? 1 : 0)};
  const double odometer_m = odometer_m_;
  *this = LocalMap(config_, centre_in_odom_m, evidence_.help());
  submap_id_ = next;
  odometer_m_ = odometer_m;
}

void LocalMap::write(std::vector<std::byte>& bytes) const {
  put(bytes, evidence().window());
  put_all(bytes, evidence().so_cells());
  put_all(bytes, evidence().mo_cells());
  put_all(bytes, evidence().lasting_cells());
  put_all(bytes, inherited_so_);
  put_all(bytes, inherited_mo_);
  put_all(bytes, inherited_lasting_);
  put(bytes, surfels_.window());
  put_surfels(bytes, surfels_);
  put_surfels(bytes, inherited_surfels_);
  put(bytes, submap_id_);
  put(bytes, odom_from_submap_);
  put(bytes, first_stamp_ns_);
  put(bytes, last_stamp_ns_);
  put(bytes, scans_);
  put(bytes, odometer_m_);
  put(bytes, counted_to_m_.has_value());
  put(bytes, counted_to_m_.value_or(Vector2::Zero()));
}

std::optional<LocalMap> LocalMap::restored(const LocalMapConfig& config, ByteReader& from,
                                           work::SideWork* help) {
  LocalMap map;
  map.config_ = config;
  map.free_steps_ = free_steps(config);
  map.end_cell_tolerance_ = end_cell_tolerance(config);
  grids::GridWindow window;
  grids::GridWindow surfel_lattice;
  std::vector<std::int8_t> so;
  std::vector<std::uint8_t> mo;
  std::vector<std::int8_t> lasting;
  from.get(window);
  from.get_all(so);
  from.get_all(mo);
  from.get_all(lasting);
  from.get_all(map.inherited_so_);
  from.get_all(map.inherited_mo_);
  from.get_all(map.inherited_lasting_);
  from.get(surfel_lattice);
  const std::vector<StoredSurfel> surfels = get_surfels(from);
  const std::vector<StoredSurfel> inherited_surfels = get_surfels(from);
  from.get(map.submap_id_);
  from.get(map.odom_from_submap_);
  from.get(map.first_stamp_ns_);
  from.get(map.last_stamp_ns_);
  from.get(map.scans_);
  bool has_counted = false;
  Vector2 counted_to_m = Vector2::Zero();
  from.get(map.odometer_m_);
  from.get(has_counted);
  from.get(counted_to_m);
  if (has_counted) map.counted_to_m_ = counted_to_m;
  const auto is_of_map = [&](std::size_t count) { return count == window.cell_count(); };
  const auto is_of_surfels = [&](const StoredSurfel& one) {
    return is_possible(one.moments, config.surfel_size_m);
  };
  const bool fits =
      from.ok() && is_like(window, evidence_window(config, {0.0, 0.0})) &&
      is_like(surfel_lattice, surfel_window(config, {0.0, 0.0})) && is_of_map(so.size()) &&
      is_of_map(mo.size()) && is_of_map(lasting.size()) && is_of_map(map.inherited_so_.size()) &&
      is_of_map(map.inherited_mo_.size()) && is_of_map(map.inherited_lasting_.size()) &&
      std::all_of(surfels.begin(), surfels.end(), is_of_surfels) &&
      std::all_of(inherited_surfels.begin(), inherited_surfels.end(), is_of_surfels) &&
      is_believable(map.odom_from_submap_) && map.odometer_m_ >= 0.0 &&
      std::isfinite(map.odometer_m_) && counted_to_m.allFinite();
  if (!fits) return std::nullopt;
  map.evidence_ =
      DeferredEvidence(grids::EvidenceGrid(window, config.evidence, config.lasting), help);
  map.evidence_.grid().set_cells(std::move(so), std::move(mo), std::move(lasting));
  map.surfels_ = grids::SurfelMap(surfel_lattice, kSurfelWeightLimit);
  map.inherited_surfels_ = map.surfels_;
  for (const StoredSurfel& surfel : surfels) map.surfels_.set_moments(surfel.cell, surfel.moments);
  for (const StoredSurfel& surfel : inherited_surfels)
    map.inherited_surfels_.set_moments(surfel.cell, surfel.moments);
  return map;
}

}  // namespace slammot::localization
