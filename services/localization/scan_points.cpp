#include "services/localization/scan_points.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/matching/body.hpp"
#include "common/sensing/deskew.hpp"
#include "services/localization/label_echo.hpp"

namespace slammot::localization {

namespace {

constexpr double kRangeNoisePerM = 0.001;  ///< Increase of range_noise_m with range.
constexpr double kWholeScanPoints = 100.0;
constexpr double kWidestObject_m = 1.2;
constexpr double kSmallSurfels_m = 0.4;  ///< Of rooms, in which walls tell of all directions, and a
                                         ///< piece of wall seen by one beam looks alone.

}  // namespace

void ScanPoints::begin_scan(const std::vector<std::size_t>& companion_beams) {
  companion_beams_ = companion_beams;
  left_out_beams_.clear();
  matched_before_.swap(matched_);
}

void ScanPoints::deskew(const sensing::LaserScan& scan, double speed_mps, double yaw_rate_radps) {
  sensing::deskew(scan, speed_mps, yaw_rate_radps, points_in_base_m_);
  const double widest_m = config_.map.surfel_size_m < kSmallSurfels_m ? 0.0 : kWidestObject_m;
  whole_objects_.find(scan, points_in_base_m_, config_.echoes.min_range_m, widest_m);
}

bool ScanPoints::is_candidate(const sensing::LaserScan& scan, std::size_t beam) const {
  const float range_m = scan.range_m[beam];
  return sensing::is_echo(range_m,
                          std::min(config_.echoes.match_range_m, scan.scanner.max_range_m)) &&
         range_m >= config_.echoes.min_range_m &&
         !std::ranges::binary_search(companion_beams_, beam);
}

void ScanPoints::select(const sensing::LaserScan& scan, const geometry::Pose2& odom_from_base,
                        const std::vector<grids::Box>& masks) {
  matched_.clear();
  matched_beams_.clear();
  candidate_beams_.clear();
  laser_in_base_m_ = scan.scanner.base_from_laser.translation_m();
  const geometry::Matrix2 turn = geometry::rotation(odom_from_base.heading_rad);
  for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam) {
    if (!is_candidate(scan, beam)) continue;
    const geometry::Vector2 in_odom_m =
        odom_from_base.translation_m() + turn * points_in_base_m_[beam];
    if (std::ranges::any_of(masks, [&](const grids::Box& mask) { return mask.covers(in_odom_m); }))
      continue;
    candidate_beams_.push_back(beam);
    if (std::ranges::binary_search(left_out_beams_, beam)) continue;
    matched_.push_back(
        {points_in_base_m_[beam],
         config_.echoes.range_noise_m + kRangeNoisePerM * static_cast<double>(scan.range_m[beam]),
         whole_objects_.width_m(beam), whole_objects_.points(beam)});
    matched_beams_.push_back(beam);
  }
}

std::size_t ScanPoints::independent() const {
  return config_.trust.mover_may_fill_view
             ? matching::independent_points(matched_, config_.match.body_length_m)
             : matched_.size();
}

double ScanPoints::evidence_share() const {
  return std::min(1.0, static_cast<double>(independent()) / kWholeScanPoints);
}

bool ScanPoints::leave_out(const std::vector<flow::PointLabel>& labels) {
  std::vector<std::size_t> left_out;
  std::ranges::copy_if(candidate_beams_, std::back_inserter(left_out), [&](std::size_t beam) {
    return echo_of(labels[beam]) != grids::Echo::kStationary;
  });
  if (left_out == left_out_beams_) return false;
  left_out_beams_ = std::move(left_out);
  return true;
}

}  // namespace slammot::localization
