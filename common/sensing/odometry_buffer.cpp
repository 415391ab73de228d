#include "common/sensing/odometry_buffer.hpp"

#include <algorithm>

namespace slammot::sensing {
namespace {

bool is_before(const Odometry& sample, std::int64_t stamp_ns) { return sample.stamp_ns < stamp_ns; }

}  // namespace

OdometryBuffer::OdometryBuffer(std::size_t capacity) : capacity_(capacity) { samples_.reserve(2 * capacity); }

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
  const double fraction = static_cast<double>(stamp_ns - before.stamp_ns) / static_cast<double>(after->stamp_ns - before.stamp_ns);
  return geometry::interpolate(before.wheel_from_base, after->wheel_from_base, fraction);
}

}  // namespace slammot::sensing
