#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "common/flow/segmented_scan.hpp"
#include "services/tracking/footprint.hpp"
#include "services/tracking/observation.hpp"
#include "services/tracking/polar_view.hpp"

namespace slammot::tracking {

/// The beams that point at a footprint.
struct Visibility {
  int beams = 0;
  int blocked = 0;     ///< Of them, ended in front of it.
  int passed = 0;      ///< Ended behind it.
  int unanswered = 0;  ///< Without an echo: passed, or absorbed by a dark surface.
};

/// The current scan in odom. Refers to the scan, which must outlive the use of this.
class ScanView {
 public:
  ScanView() = default;
  explicit ScanView(const flow::SegmentedScan& scan) { look_at(scan); }
  /// Replaces the scan; reuses the memory.
  void look_at(const flow::SegmentedScan& scan);

  const flow::SegmentedScan& scan() const { return *scan_; }
  const PolarView& polar() const { return polar_; }
  const Eigen::Vector2d& point_in_odom_m(std::size_t beam) const {
    return polar_.point_in_odom_m(beam);
  }
  const Eigen::Vector2d& laser_in_odom_m() const { return polar_.laser_in_odom_m(); }
  double beam_step_rad() const { return polar_.beam_step_rad(); }  ///< Positive.
  /// Segment of the beam's echo; kNone without an echo.
  std::size_t segment_of_beam(std::size_t beam) const { return segment_of_beam_[beam]; }
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// A run of beams, clipped to the scan.
  struct Directions {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  /// Those that point at the footprint.
  Directions directions_of(const Footprint& footprint, const Eigen::Vector2d& centre_m,
                           double margin_m) const;

  Visibility visibility_of(const Footprint& footprint, const Eigen::Vector2d& centre_m) const;

 private:
  const flow::SegmentedScan* scan_ = nullptr;
  PolarView polar_;
  std::vector<std::size_t> segment_of_beam_;
};

/// What is beside the echo of a beam, `step` (+1 or -1) beams on. An equally distant echo that is
/// not known to be stationary hides the end, too: the object may continue there as another segment.
/// size_scale: of all lengths, relative to real road users.
Edge edge_beyond(const ScanView& view, std::size_t beam, int step, double size_scale);

}  // namespace slammot::tracking
