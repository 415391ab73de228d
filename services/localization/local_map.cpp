#include "services/localization/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "services/localization/local_map_windows.hpp"
#include "services/localization/submap_cells.hpp"

namespace slammot::localization {
namespace {

using geometry::Vector2;

constexpr double kSurfelWeightLimit = 1000.0;  // Echoes after which a surfel's mean becomes a
                                               // running one.

constexpr std::uint32_t kScansBetweenCleanings = 10;
constexpr double kInheritedShareOfLimit = 0.75;

int end_cell_tolerance(const LocalMapConfig& config) {
  return static_cast<int>(std::ceil(config.end_cell_tolerance_m / config.cell_size_m - 0.5));
}

geometry::Pose2 pose_of_window(const grids::GridWindow& window) {
  const Vector2 centre_m = window.centre_of(
      {window.first.column + window.columns / 2, window.first.row + window.rows / 2});
  return {centre_m.x(), centre_m.y(), 0.0};
}

}  // namespace

LocalMap::LocalMap(const LocalMapConfig& config, const Vector2& centre_in_odom_m,
                   work::SideWork* help, flow::SubmapId first)
    : LocalMap(config, evidence_window(config, centre_in_odom_m),
               surfel_window(config, centre_in_odom_m), help) {
  inherited_ = std::make_shared<const Inherited>(held());
  submap_id_ = first;
}

LocalMap::LocalMap(const LocalMapConfig& config, const grids::GridWindow& window,
                   const grids::GridWindow& surfel_lattice, work::SideWork* help)
    : config_(config),
      free_steps_(grids::steps_of_log_odds(config.free_log_odds)),
      end_cell_tolerance_(end_cell_tolerance(config)),
      evidence_(grids::EvidenceGrid(window, config.evidence, config.lasting), help),
      surfels_(surfel_lattice, kSurfelWeightLimit),
      odom_from_submap_(pose_of_window(window)) {}

LocalMap::Inherited LocalMap::held() const {
  return {evidence().so_cells(), evidence().mo_cells(), evidence().lasting_cells(), surfels_};
}

Vector2 LocalMap::window_centre_m() const { return odom_from_submap_.translation_m(); }

void LocalMap::prepare(const Vector2& origin_m, const std::vector<grids::Ray>& rays,
                       double beam_step_rad) {
  evidence_.prepare(origin_m, rays, beam_step_rad);
}

void LocalMap::integrate(std::int64_t stamp_ns, const Vector2& origin_m,
                         const std::vector<grids::Ray>& rays, double beam_step_rad) {
  if (progress_.first_stamp_ns == kNotBegun) progress_.first_stamp_ns = stamp_ns;
  odometer_.count(origin_m);
  progress_.last_stamp_ns = stamp_ns;
  ++progress_.scans;
  evidence_.integrate(origin_m, rays, beam_step_rad);
  stationary_m_.clear();
  for (const grids::Ray& ray : rays) {
    if (ray.echo == grids::Echo::kStationary) stationary_m_.push_back(ray.end_m);
  }
  surfels_.add_all(stationary_m_, odometer_.way_m);
  if (progress_.scans % kScansBetweenCleanings == 0) forget_surfels_in_free_space();
}

void LocalMap::Odometer::count(const Vector2& origin_m) {
  constexpr double kMoreThanJitter_m = 0.1;
  const double step_m = counted_to_m ? (origin_m - *counted_to_m).norm() : 0.0;
  if (counted_to_m && step_m < kMoreThanJitter_m) return;
  way_m += step_m;
  counted_to_m = origin_m;
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
  surfels_.add(point_in_odom_m, odometer_.way_m);
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
  const grids::GridWindow bounds =
      bounds_of_seen(window, {evidence.lasting_cells(), evidence.mo_cells()},
                     {inherited_->lasting, inherited_->mo});
  flow::Submap submap;
  submap.submap_id = submap_id_;
  submap.first_stamp_ns = progress_.first_stamp_ns;
  submap.last_stamp_ns = progress_.last_stamp_ns;
  submap.odom_from_submap = odom_from_submap_;
  submap.cell_size_m = window.cell_size_m;
  submap.min_x_m = bounds.first.column * window.cell_size_m - odom_from_submap_.x_m;
  submap.min_y_m = bounds.first.row * window.cell_size_m - odom_from_submap_.y_m;
  submap.columns = static_cast<std::uint32_t>(bounds.columns);
  submap.rows = static_cast<std::uint32_t>(bounds.rows);
  put_own_cells(bounds, submap);
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

void LocalMap::put_own_cells(const grids::GridWindow& bounds, flow::Submap& submap) const {
  const grids::EvidenceGrid& evidence = evidence_.grid();
  submap.so_log_odds.resize(bounds.cell_count());
  submap.mo_evidence.resize(bounds.cell_count());
  for (std::int32_t row = 0; row < bounds.rows; ++row) {
    const std::size_t from = evidence.window().index({bounds.first.column, bounds.first.row + row});
    const std::ptrdiff_t to = std::ptrdiff_t{row} * bounds.columns;
    put_own_so(evidence.lasting_cells().data() + from, inherited_->lasting.data() + from,
               bounds.columns, submap.so_log_odds.data() + to);
    put_own_mo(evidence.mo_cells().data() + from, inherited_->mo.data() + from, bounds.columns,
               submap.mo_evidence.data() + to);
  }
}

std::optional<flow::Surfel> LocalMap::own_surfel(const grids::SurfelView& surfel) const {
  if (surfel.own_echoes <= 0.0) return std::nullopt;
  const grids::CellMoments& all = *surfels_.moments_at(surfel.cell);
  const grids::CellMoments* inherited = inherited_->surfels.moments_at(surfel.cell);
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
  std::vector<std::int8_t> so = evidence().so_cells();
  keep_changed(so.data(), inherited_->so.data(), so.size(),
               grids::steps_of_log_odds(kInheritedShareOfLimit * config_.evidence.limit_log_odds));
  std::vector<std::int8_t> lasting = evidence().lasting_cells();
  keep_changed_or_driven_over(
      lasting.data(), inherited_->lasting.data(), lasting.size(),
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
  inherited_ = std::make_shared<const Inherited>(held());
  odom_from_submap_ = pose_of_window(evidence().window());
  ++submap_id_.value;
  progress_.first_stamp_ns = kNotBegun;
  progress_.scans = 0;
}

void LocalMap::begin_astray(const Vector2& centre_in_odom_m, std::int64_t since_ns) {
  const flow::SubmapId next{submap_id_.value + (has_echoes() ? 1 : 0)};
  const double way_m = odometer_.way_m;
  *this = LocalMap(config_, centre_in_odom_m, evidence_.help());
  submap_id_ = next;
  odometer_.way_m = way_m;
  progress_.first_stamp_ns = since_ns;
}

}  // namespace slammot::localization
