#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// The last odometry samples, ordered by stamp. Samples may arrive late or repeated; the first one
/// of each stamp is kept.
class OdometryBuffer {
 public:
  explicit OdometryBuffer(std::size_t capacity = 512);

  void add(const Odometry& sample);

  /// True if a sample at or after the stamp exists, so that waiting is unnecessary.
  bool reaches(std::int64_t stamp_ns) const {
    return !samples_.empty() && samples_.back().stamp_ns >= stamp_ns;
  }

  bool empty() const { return samples_.empty(); }
  std::optional<std::int64_t> newest_ns() const {
    return samples_.empty() ? std::nullopt : std::optional(samples_.back().stamp_ns);
  }

  /// Pose at the stamp by interpolation; none outside the buffered time.
  std::optional<geometry::Pose2> wheel_from_base_at(std::int64_t stamp_ns) const;

  /// Pose at this offset from the stamp, as known at the stamp. A later pose is extrapolated at the
  /// last velocity even if later samples exist, so that successive steps add up.
  std::optional<geometry::Pose2> wheel_from_base_after(std::int64_t stamp_ns,
                                                       std::int64_t after_ns) const;

  /// Samples from the stamp on, in order.
  std::vector<Odometry> since(std::int64_t stamp_ns) const;

  /// True if no gap between neighbouring samples around the interval is larger. It is false for
  /// logs with odometry stamped in bursts.
  bool is_dense(std::int64_t from_ns, std::int64_t to_ns, std::int64_t gap_ns) const;

 private:
  std::size_t capacity_;
  std::vector<Odometry> samples_;  ///< Ascending stamps.
};

}  // namespace slammot::sensing
