#include "common/city_model/profile_model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace slammot::city_model {
/// Poses at the first beam and at the last one.
struct Sweep {
  geometry::Pose2 begin;
  geometry::Pose2 end;
};

namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr std::int64_t kLongestGap_ns = 1'000'000'000;  ///< Between two poses.

std::optional<Sweep> sweep(const metrics::Trajectory& trajectory, const sensing::LaserScan& scan) {
  const std::int64_t sweep_ns = std::llround(1e9 * scan.scanner.sweep_s);
  const auto begin = metrics::pose_at(trajectory, scan.stamp_ns, kLongestGap_ns);
  const auto end = metrics::pose_at(trajectory, scan.stamp_ns + sweep_ns, kLongestGap_ns);
  if (!begin || !end) return std::nullopt;
  return Sweep{*begin, *end};
}

Vector2 placed(const Sweep& sweep, double fraction, const Eigen::Vector3d& point_in_base_m) {
  return geometry::interpolate(sweep.begin, sweep.end, fraction) *
         Vector2(point_in_base_m.head<2>());
}

/// True if no cell of the map within the reach is anything but free.
bool is_free_around(const metrics::OccupancyCells& map, const Vector2& point_in_map_m) {
  constexpr double kReach_m = 0.3;
  const auto index = [&](double value_m, double min_m) {
    return static_cast<std::int64_t>(std::floor((value_m - min_m) / map.cell_size_m));
  };
  const std::int64_t column = index(point_in_map_m.x(), map.min_x_m);
  const std::int64_t row = index(point_in_map_m.y(), map.min_y_m);
  const auto reach = static_cast<std::int64_t>(std::ceil(kReach_m / map.cell_size_m));
  const auto columns = static_cast<std::int64_t>(map.columns);
  const auto rows = static_cast<std::int64_t>(map.rows);
  if (column < reach || row < reach || column + reach >= columns || row + reach >= rows)
    return false;
  for (std::int64_t y = row - reach; y <= row + reach; ++y) {
    for (std::int64_t x = column - reach; x <= column + reach; ++x) {
      if (map.state[static_cast<std::size_t>(y * columns + x)] != metrics::CellState::kFree)
        return false;
    }
  }
  return true;
}

}  // namespace

struct ProfileModel::ScanPoses {
  Sweep corrected;
  Sweep online;
  std::vector<TrackedBox> boxes;  ///< In the frame of `online`.
};

void ProfileModel::add(const sensing::LaserScan& scan, const sensing::SpatialMounting& mounting) {
  ++counts_.scans;
  const auto corrected = sweep(drive_.corrected, scan);
  const auto online = sweep(drive_.online, scan);
  if (!corrected || !online) return void(++counts_.scans_without_pose);
  points_in_base_m_.clear();
  beams_.clear();
  const double longest_m = std::min(config_.longest_range_m, scan.scanner.max_range_m);
  for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam) {
    if (!sensing::is_echo(scan.range_m[beam], longest_m)) continue;
    points_in_base_m_.push_back(
        sensing::point_in_base_m(mounting, sensing::beam_angle_rad(scan.scanner, beam),
                                 static_cast<double>(scan.range_m[beam])));
    beams_.push_back(static_cast<std::uint16_t>(beam));
  }
  counts_.echoes += beams_.size();
  road_.add(points_in_base_m_);
  place(scan, {*corrected, *online, drive_.movers.at(scan.stamp_ns)});
}

void ProfileModel::place(const sensing::LaserScan& scan, const ScanPoses& poses) {
  const auto last = static_cast<double>(std::max<std::size_t>(1, scan.range_m.size() - 1));
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    const double height_m = points_in_base_m_[i].z() - road_.height_m();
    if (height_m < config_.least_height_m) {
      ++counts_.of_road;
      continue;
    }
    const double fraction = static_cast<double>(beams_[i]) / last;
    const Vector2 online_m = placed(poses.online, fraction, points_in_base_m_[i]);
    if (std::ranges::any_of(poses.boxes,
                            [&](const TrackedBox& box) { return contains(box, online_m); })) {
      ++counts_.of_movers;
      continue;
    }
    const Vector2 point_m = placed(poses.corrected, fraction, points_in_base_m_[i]);
    const Eigen::Vector3f position_m(static_cast<float>(point_m.x()),
                                     static_cast<float>(point_m.y()), static_cast<float>(height_m));
    columns_[cell_of(position_m, config_.cell_size_m)].push_back(
        {position_m, static_cast<std::uint32_t>(counts_.scans - 1), beams_[i]});
  }
}

/// True if something stands there by the column's low echoes, and the SO-map shows free space: it
/// has moved away.
bool ProfileModel::is_free(const std::vector<PlacedEcho>& column) const {
  constexpr float kLow_m = 1.3F;  // planar scanners look below it
  Vector2 sum = Vector2::Zero();
  double count = 0.0;
  for (const PlacedEcho& echo : column) {
    if (echo.position_in_map_m.z() > kLow_m) continue;
    sum += echo.position_in_map_m.head<2>().cast<double>();
    count += 1.0;
  }
  return count > 0.0 && is_free_around(drive_.stationary, sum / count);
}

/// Removes what is as high as a vehicle from columns in free space; what is above it hangs there.
void ProfileModel::leave_out_free_space() {
  constexpr float kVehicle_m = 4.0F;
  if (drive_.stationary.state.empty()) return;
  for (auto& [cell, column] : columns_) {
    if (!is_free(column)) continue;
    counts_.in_free_space += std::erase_if(
        column, [](const PlacedEcho& echo) { return echo.position_in_map_m.z() < kVehicle_m; });
  }
}

CityModel ProfileModel::finish() {
  leave_out_free_space();
  CityModel model;
  for (const auto& [cell, column] : columns_)
    model.points.insert(model.points.end(), column.begin(), column.end());
  model.facades = facades_of(columns_, config_.cell_size_m);
  model.counts = counts_;
  return model;
}

}  // namespace slammot::city_model
