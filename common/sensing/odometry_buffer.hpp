#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// The last odometry samples, by stamp. Samples may come late or twice; each stamp is kept once, the first wins.
class OdometryBuffer {
 public:
  explicit OdometryBuffer(std::size_t capacity = 512);

  void add(const Odometry& sample);

  /// Whether a sample at or after the stamp is known, so that waiting for more is pointless.
  bool reaches(std::int64_t stamp_ns) const { return !samples_.empty() && samples_.back().stamp_ns >= stamp_ns; }

  bool empty() const { return samples_.empty(); }

  /// Pose at the stamp, interpolated between the neighbours; none outside what is known.
  std::optional<geometry::Pose2> wheel_from_base_at(std::int64_t stamp_ns) const;

  /// Pose so much after the stamp (or before it), told from what was known at the stamp: after it, it goes on at the velocity of
  /// the last moments, even where later samples are known by now, so that steps from one stamp to the next add up.
  std::optional<geometry::Pose2> wheel_from_base_after(std::int64_t stamp_ns, std::int64_t after_ns) const;

  /// The samples from the stamp on, by stamp.
  std::vector<Odometry> since(std::int64_t stamp_ns) const;

  /// Whether no two neighbours from before the one stamp until after the other are farther apart. Where a log's samples were stamped in bursts, they are.
  bool is_dense(std::int64_t from_ns, std::int64_t to_ns, std::int64_t gap_ns) const;

 private:
  std::size_t capacity_;
  std::vector<Odometry> samples_;  ///< Ascending stamps.
};

}  // namespace slammot::sensing
