#pragma once

#include <array>
#include <cstddef>

#include "common/geometry/pose2.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// Kernel density of the next step between scans, from the last steps: one kernel at each step and
/// one at its mirror image. A robot that logs a scan every metre and every half radian repeats its
/// steps.
class StepHistory {
 public:
  static constexpr std::size_t kKept = 48;

  /// before_from_base: base at a scan, in the base frame of the previous scan.
  void add(const geometry::Pose2& before_from_base);

  std::size_t size() const { return size_; }

  /// Log marginal likelihood of a scan [nats], up to a constant of the scan: see
  /// log_marginal_likelihood(). The density is the mixture of the kept steps and `wide`, whose
  /// weight is that of kWideSteps steps. before: pose at the last scan; poses are in its frame.
  double log_marginal(const geometry::UncertainPose2& before, const geometry::UncertainPose2& wide,
                      const geometry::Pose2& optimum, const geometry::Matrix3& information) const;

  /// True if all steps are finite; false after a damaged checkpoint.
  bool is_sound() const;

 private:
  std::array<geometry::Pose2, kKept> steps_{};  ///< Ring buffer.
  std::size_t size_ = 0;
  std::size_t next_ = 0;
};

}  // namespace slammot::sensing
