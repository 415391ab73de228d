#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/flow/segmented_scan.hpp"
#include "services/tracking/body.hpp"

namespace slammot::tracking {

/// How much of a body the scan could have seen.
struct Visibility {
  int beams = 0;               ///< That point at the body,
  int blocked = 0;             ///< of which so many ended in front of it
  int passed = 0;              ///< and so many went through to something behind it, or came back from nothing.
};

/// One scan in odom, with the means to ask what lies in a direction. Refers to the scan, which must outlive it.
class ScanView {
 public:
  explicit ScanView(const flow::SegmentedScan& scan);

  const flow::SegmentedScan& scan() const { return *scan_; }
  const Eigen::Vector2d& point_in_odom_m(std::size_t beam) const { return points_in_odom_m_[beam]; }
  const Eigen::Vector2d& laser_in_odom_m() const { return laser_in_odom_m_; }
  double beam_step_rad() const { return beam_step_rad_; }   ///< Positive.
  /// Segment of the beam's echo; kNone without echo.
  std::size_t segment_of_beam(std::size_t beam) const { return segment_of_beam_[beam]; }
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Beams [first, last) that point at the body, clipped to the scan; empty where first == last.
  struct Directions {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  Directions directions_of(const Body& body, const Eigen::Vector2d& centre_m, double margin_m) const;

  Visibility visibility_of(const Body& body, const Eigen::Vector2d& centre_m) const;

 private:
  const flow::SegmentedScan* scan_;
  std::vector<Eigen::Vector2d> points_in_odom_m_;
  std::vector<std::size_t> segment_of_beam_;
  Eigen::Vector2d laser_in_odom_m_;
  double first_beam_in_odom_rad_ = 0.0;
  double beam_step_rad_ = 0.0;
  bool is_clockwise_ = false;
};

}  // namespace slammot::tracking
