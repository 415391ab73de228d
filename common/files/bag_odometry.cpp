#include "common/files/bag_odometry.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace slammot::files {

namespace {

struct Lag {
  std::int64_t median_ns = 0;
  bool is_steady = false;
};

Lag lag_of(std::vector<std::int64_t>& lags_ns) {
  constexpr std::int64_t kSteady_ns = 200'000'000;  // between the quartiles
  if (lags_ns.empty()) return {};
  std::ranges::sort(lags_ns);
  const std::size_t count = lags_ns.size();
  return {lags_ns[count / 2], lags_ns[3 * count / 4] - lags_ns[count / 4] < kSteady_ns};
}

}  // namespace

std::int64_t odometry_clock_ahead_ns(std::vector<std::int64_t> lags_of_scans_ns,
                                     const std::vector<BagPose>& odometry) {
  constexpr std::int64_t kOnItsWay_ns = 500'000'000;
  std::vector<std::int64_t> lags_ns;
  for (const BagPose& pose : odometry)
    lags_ns.push_back(pose.times.log_time_ns - pose.times.stamp_ns);
  const Lag of_scans = lag_of(lags_of_scans_ns);
  const Lag of_odometry = lag_of(lags_ns);
  const std::int64_t ahead_ns = of_scans.median_ns - of_odometry.median_ns;
  const bool is_told =
      of_scans.is_steady && of_odometry.is_steady && std::abs(ahead_ns) > kOnItsWay_ns;
  return is_told ? ahead_ns : 0;
}

BagOdometry::BagOdometry(std::vector<BagPose> poses, Clock clock)
    : poses_(std::move(poses)), by_time_(poses_), clock_(clock) {
  std::ranges::stable_sort(by_time_, {},
                           [this](const BagPose& pose) { return time_of(pose.times); });
  std::int64_t newest_ns = 0;
  for (BagPose& pose : poses_)
    pose.times.log_time_ns = newest_ns = std::max(newest_ns, pose.times.log_time_ns);
}

std::int64_t BagOdometry::time_of(const MessageTimes& times) const {
  if (clock_ == Clock::kOrder) return times.index;
  return clock_ == Clock::kHeaders ? times.stamp_ns : times.log_time_ns;
}

/// Odometry at exactly the scan's stamp: the last one before it in the bag. With the bag's order,
/// the one before it.
const BagPose* BagOdometry::pose_of(const MessageTimes& scan) const {
  const std::int64_t time = time_of(scan);
  const auto first = std::ranges::lower_bound(
      by_time_, time, {}, [this](const BagPose& pose) { return time_of(pose.times); });
  if (clock_ == Clock::kOrder) return first == by_time_.begin() ? nullptr : &*(first - 1);
  const BagPose* best = nullptr;
  for (auto pose = first; pose != by_time_.end() && time_of(pose->times) == time; ++pose) {
    if (best == nullptr || pose->times.index < scan.index) best = &*pose;
  }
  return best;
}

geometry::Pose2 BagOdometry::wheel_from_base_at(const MessageTimes& scan) const {
  if (by_time_.empty()) return geometry::Pose2::identity();
  if (const BagPose* const pose = pose_of(scan)) return pose->wheel_from_base;
  const std::int64_t time = time_of(scan);
  const auto after = std::ranges::lower_bound(
      by_time_, time, {}, [this](const BagPose& pose) { return time_of(pose.times); });
  if (after == by_time_.end()) return by_time_.back().wheel_from_base;
  if (after == by_time_.begin()) return after->wheel_from_base;
  const BagPose& before = *(after - 1);
  const double fraction = static_cast<double>(time - time_of(before.times)) /
                          static_cast<double>(time_of(after->times) - time_of(before.times));
  return geometry::interpolate(before.wheel_from_base, after->wheel_from_base, fraction);
}

bool BagOdometry::comes_before(const BagPose& pose, const MessageTimes& scan) const {
  return clock_ == Clock::kOrder ? pose.times.index < scan.index
                                 : pose.times.log_time_ns <= scan.log_time_ns;
}

bool BagOdometry::is_told_by(const MessageTimes* waiting_scan, const BagPose& pose) const {
  const BagPose* const of_waiting = waiting_scan != nullptr ? pose_of(*waiting_scan) : nullptr;
  return (of_waiting != nullptr && of_waiting->times.index == pose.times.index) ||
         std::ranges::find(told_, pose.times.index) != told_.end();
}

void BagOdometry::note_told(const MessageTimes& scan) {
  constexpr std::size_t kRemembered = 64;
  const BagPose* const pose = pose_of(scan);
  if (pose == nullptr) return;
  if (told_.size() == kRemembered) told_.erase(told_.begin());
  told_.push_back(pose->times.index);
}

}  // namespace slammot::files
