#include "common/sensing/odometry_buffer.hpp"

#include <algorithm>

namespace slammot::sensing {
namespace {

constexpr std::int64_t kVelocityOver_ns = 100'000'000;  // over a shorter time the noise of two
                                                        // samples dominates the velocity

bool is_before(const Odometry& sample, std::int64_t stamp_ns) { return sample.stamp_ns < stamp_ns; }

}  // namespace

OdometryBuffer::OdometryBuffer(std::size_t capacity) : capacity_(capacity) {
  samples_.reserve(2 * capacity);
}

void OdometryBuffer::add(const Odometry& sample) {
  const auto place = std::lower_bound(samples_.begin(), samples_.end(), sample.stamp_ns, is_before);
  if (place != samples_.end() && place->stamp_ns == sample.stamp_ns) return;
  samples_.insert(place, sample);
  if (samples_.size() == 2 * capacity_) {
    samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(capacity_));
  }
}

std::optional<geometry::Pose2> OdometryBuffer::wheel_from_base_at(std::int64_t stamp_ns) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), stamp_ns, is_before);
  if (after == samples_.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->wheel_from_base;
  if (after == samples_.begin()) return std::nullopt;
  const Odometry& before = *(after - 1);
  const double fraction = static_cast<double>(stamp_ns - before.stamp_ns) /
                          static_cast<double>(after->stamp_ns - before.stamp_ns);
  return geometry::interpolate(before.wheel_from_base, after->wheel_from_base, fraction);
}

std::optional<geometry::Pose2> OdometryBuffer::wheel_from_base_after(std::int64_t stamp_ns,
                                                                     std::int64_t after_ns) const {
  if (after_ns <= 0) return wheel_from_base_at(stamp_ns + after_ns);
  const auto at_stamp = wheel_from_base_at(stamp_ns);
  const auto earlier = wheel_from_base_at(stamp_ns - kVelocityOver_ns);
  if (!at_stamp || !earlier) return std::nullopt;
  return geometry::interpolate(
      *earlier, *at_stamp,
      1.0 + static_cast<double>(after_ns) / static_cast<double>(kVelocityOver_ns));
}

std::vector<Odometry> OdometryBuffer::since(std::int64_t stamp_ns) const {
  return {std::lower_bound(samples_.begin(), samples_.end(), stamp_ns, is_before), samples_.end()};
}

bool OdometryBuffer::is_dense(std::int64_t from_ns, std::int64_t to_ns, std::int64_t gap_ns) const {
  auto after = std::lower_bound(samples_.begin(), samples_.end(), from_ns, is_before);
  if (after == samples_.begin()) return false;
  for (; after != samples_.end(); ++after) {
    if (after->stamp_ns - (after - 1)->stamp_ns > gap_ns) return false;
    if (after->stamp_ns >= to_ns) return true;
  }
  return false;
}

}  // namespace slammot::sensing
