#include "services/localization/submap_measurements.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slammot::localization {
namespace {

using geometry::Pose2;

constexpr std::size_t kMostWaiting = 1024;
constexpr std::size_t kMostKeptPoses = 256;  // some seconds of scans: receivers report late
constexpr double kFixSpacing_m = 2.0;
constexpr double kReadingSpacing_m = 1.0;

template <typename Measurement>
void keep_waiting(Measurement measurement, std::deque<Measurement>& waiting) {
  if (waiting.size() == kMostWaiting) waiting.pop_front();
  waiting.push_back(std::move(measurement));
}

}  // namespace

SubmapMeasurements::SubmapMeasurements() { poses_.reserve(2 * kMostKeptPoses); }

void SubmapMeasurements::add(const sensing::GnssFix& fix) {
  const bool is_sound = std::isfinite(fix.position.latitude_deg) &&
                        std::isfinite(fix.position.longitude_deg) && fix.covariance_m2.allFinite();
  if (fix.quality != sensing::GnssQuality::no_fix && is_sound) keep_waiting(fix, waiting_fixes_);
}

void SubmapMeasurements::add(const sensing::CompassReading& reading) {
  if (std::isfinite(reading.heading_from_east_rad) && std::isfinite(reading.sigma_rad))
    keep_waiting(reading, waiting_readings_);
}

bool SubmapMeasurements::is_waited_for(std::int64_t stamp_ns) const {
  return poses_.empty() || stamp_ns > poses_.back().stamp_ns;
}

/// None outside of the latest poses.
std::optional<Pose2> SubmapMeasurements::pose_at(std::int64_t stamp_ns) const {
  const auto after = std::ranges::lower_bound(poses_, stamp_ns, {}, &StampedPose::stamp_ns);
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->odom_from_base;
  if (after == poses_.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  const double fraction = static_cast<double>(stamp_ns - before.stamp_ns) /
                          static_cast<double>(after->stamp_ns - before.stamp_ns);
  return geometry::interpolate(before.odom_from_base, after->odom_from_base, fraction);
}

void SubmapMeasurements::place(std::int64_t stamp_ns, const Pose2& odom_from_base) {
  if (!is_waited_for(stamp_ns)) return;
  if (poses_.size() == 2 * kMostKeptPoses)
    poses_.erase(poses_.begin(), poses_.begin() + kMostKeptPoses);
  poses_.push_back({stamp_ns, odom_from_base});
  for (; !waiting_fixes_.empty() && !is_waited_for(waiting_fixes_.front().stamp_ns);
       waiting_fixes_.pop_front())
    place(waiting_fixes_.front());
  for (; !waiting_readings_.empty() && !is_waited_for(waiting_readings_.front().stamp_ns);
       waiting_readings_.pop_front())
    place(waiting_readings_.front());
}

void SubmapMeasurements::place(const sensing::GnssFix& fix) {
  const auto pose = pose_at(fix.stamp_ns);
  if (!pose || fixes_.size() == flow::kMostFixesOfSubmap) return;
  const geometry::Vector2 in_odom_m = pose->translation_m();
  if (fixes_.empty() || (in_odom_m - fixes_.back().in_odom_m).norm() >= kFixSpacing_m)
    fixes_.push_back({in_odom_m, fix});
}

void SubmapMeasurements::place(const sensing::CompassReading& reading) {
  const auto pose = pose_at(reading.stamp_ns);
  if (!pose || readings_.size() == flow::kMostHeadingsOfSubmap) return;
  const bool is_near =
      !readings_.empty() &&
      (pose->translation_m() - readings_.back().odom_from_base.translation_m()).norm() <
          kReadingSpacing_m;
  if (!is_near) readings_.push_back({*pose, reading});
}

void SubmapMeasurements::move_into(flow::Submap& submap) {
  const Pose2 submap_from_odom = geometry::inverse(submap.odom_from_submap);
  for (const PlacedFix& placed : fixes_) {
    const geometry::Vector2 in_submap_m = submap_from_odom * placed.in_odom_m;
    const geometry::Matrix2& covariance_m2 = placed.fix.covariance_m2;
    submap.fixes.push_back(
        {static_cast<float>(in_submap_m.x()), static_cast<float>(in_submap_m.y()),
         placed.fix.position, static_cast<float>(covariance_m2(0, 0)),
         static_cast<float>(covariance_m2(1, 1)), static_cast<float>(covariance_m2(0, 1))});
  }
  for (const PlacedReading& placed : readings_) {
    submap.headings.push_back(
        {static_cast<float>((submap_from_odom * placed.odom_from_base).heading_rad),
         static_cast<float>(placed.reading.heading_from_east_rad),
         static_cast<float>(placed.reading.sigma_rad)});
  }
  fixes_.clear();
  readings_.clear();
}

}  // namespace slammot::localization
