#include "examples/icp_localizer/recent_map.hpp"

#include <cmath>

#include "common/grids/log_odds.hpp"

namespace slammot::icp_localizer {
namespace {

using geometry::Vector2;

constexpr double kSurfelWeightLimit = 1000.0;
constexpr std::uint64_t kScansBetweenCleanings = 10;
constexpr std::size_t kScansKept = 20;  // scans with which the next local map begins
constexpr double kKeptScansApart_m = 0.5;

}  // namespace

RecentMap::RecentMap(const IcpLocalizerConfig& config, flow::SubmapId id,
                     const Vector2& centre_in_odom_m)
    : config_(config),
      id_(id),
      odom_from_submap_{centre_in_odom_m.x(), centre_in_odom_m.y(), 0.0},
      evidence_(grids::window_around(centre_in_odom_m, config.side_m, config.cell_size_m), {}),
      surfels_(grids::window_around(centre_in_odom_m, config.side_m, config.surfel_size_m),
               kSurfelWeightLimit) {}

void RecentMap::add(const MappedScan& scan) {
  if (scans_++ == 0) first_stamp_ns_ = scan.stamp_ns;
  last_stamp_ns_ = scan.stamp_ns;
  integrate(scan);
  if (!last_scans_.empty() && scan.travelled_m - last_scans_.back().travelled_m < kKeptScansApart_m)
    return;
  last_scans_.push_back(scan);
  if (last_scans_.size() > kScansKept) last_scans_.pop_front();
}

void RecentMap::integrate(const MappedScan& scan) {
  evidence_.integrate(scan.laser_in_odom_m, scan.rays, scan.beam_step_rad);
  for (const grids::Ray& ray : scan.rays)
    if (ray.echo == grids::Echo::kStationary) surfels_.add(ray.end_m, scan.travelled_m);
  if (scans_ % kScansBetweenCleanings != 0) return;
  const int free_steps = grids::steps_of_log_odds(config_.free_log_odds);
  surfels_.erase_where([&](const Vector2& mean_m) {
    return evidence_.highest_so_steps(evidence_.window().cell_at(mean_m.x(), mean_m.y()), 1) <=
           -free_steps;
  });
}

RecentMap RecentMap::next(const Vector2& centre_in_odom_m) const {
  RecentMap map(config_, {id_.value + 1}, centre_in_odom_m);
  map.last_scans_ = last_scans_;
  for (const MappedScan& scan : last_scans_) map.integrate(scan);
  return map;
}

void RecentMap::look_up_end(const Vector2& end_in_odom_m, flow::LocalizedBeam& beam) const {
  const grids::Cell cell = evidence_.window().cell_at(end_in_odom_m.x(), end_in_odom_m.y());
  const int so_steps = evidence_.so_steps(cell);
  const int tolerance =
      static_cast<int>(std::ceil(config_.end_cell_tolerance_m / config_.cell_size_m - 0.5));
  beam.free_evidence = static_cast<float>(-so_steps * grids::kLogOddsStep);
  beam.moving_evidence = static_cast<float>(evidence_.moving(cell)) / 255.0F;
  beam.end_cell = evidence_.is_occupied_near(cell, tolerance) ? flow::EndCell::kOccupied
                  : so_steps <= -grids::steps_of_log_odds(config_.free_log_odds)
                      ? flow::EndCell::kFree
                      : flow::EndCell::kUnseen;
}

flow::Submap RecentMap::submap() const {
  const grids::GridWindow& window = evidence_.window();
  flow::Submap submap;
  submap.submap_id = id_;
  submap.first_stamp_ns = first_stamp_ns_;
  submap.last_stamp_ns = last_stamp_ns_;
  submap.odom_from_submap = odom_from_submap_;
  submap.cell_size_m = window.cell_size_m;
  submap.min_x_m = window.first.column * window.cell_size_m - odom_from_submap_.x_m;
  submap.min_y_m = window.first.row * window.cell_size_m - odom_from_submap_.y_m;
  submap.columns = static_cast<std::uint32_t>(window.columns);
  submap.rows = static_cast<std::uint32_t>(window.rows);
  submap.so_log_odds = evidence_.so_cells();
  submap.mo_evidence = evidence_.mo_cells();
  for (const grids::SurfelView& surfel : surfels_.all()) {
    const Vector2 at_m = surfel.mean_m - odom_from_submap_.translation_m();
    submap.surfels.push_back({static_cast<float>(at_m.x()), static_cast<float>(at_m.y()),
                              static_cast<float>(surfel.normal.x()),
                              static_cast<float>(surfel.normal.y()),
                              static_cast<float>(surfel.weight)});
  }
  return submap;
}

}  // namespace slammot::icp_localizer
