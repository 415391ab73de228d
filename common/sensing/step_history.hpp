#pragma once

#include <array>
#include <cstddef>

#include "common/geometry/pose2.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// The last steps between scans as a probability density of the next one: a kernel about each step and about its mirror image. A robot that
/// logs a scan for each metre and each half radian repeats its steps.
class StepHistory {
 public:
  static constexpr std::size_t kKept = 48;

  /// before_from_base: the base at a scan, in the base at the scan before.
  void add(const geometry::Pose2& before_from_base);

  std::size_t size() const { return size_; }

  /// Log of the marginal likelihood of a scan [nats], up to a constant of the scan: see log_marginal_likelihood(). The density is that of the
  /// steps kept, mixed with `wide`, which counts for kWideSteps of them. before: pose at the last scan; poses in its frame.
  double log_marginal(const geometry::UncertainPose2& before, const geometry::UncertainPose2& wide, const geometry::Pose2& optimum,
                      const geometry::Matrix3& information) const;

  /// Whether all steps are finite: not so in a damaged checkpoint.
  bool is_sound() const;

 private:
  std::array<geometry::Pose2, kKept> steps_{};   ///< The oldest is overwritten.
  std::size_t size_ = 0;
  std::size_t next_ = 0;
};

}  // namespace slammot::sensing
