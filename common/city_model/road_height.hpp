#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace slammot::city_model {

/// Height of the road beside the vehicle in the base's frame, followed from scan to scan.
class RoadHeight {
 public:
  /// points_in_base_m: the echoes of one scan.
  void add(std::span<const Eigen::Vector3d> points_in_base_m);

  /// 0, the base's own height, until enough of the road was seen.
  double height_m() const { return height_m_; }

 private:
  double height_m_ = 0.0;
  bool is_known_ = false;
  std::vector<double> heights_m_;  ///< Of one scan; reused.
};

}  // namespace slammot::city_model
