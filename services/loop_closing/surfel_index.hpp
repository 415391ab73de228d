#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/flow/submap.hpp"

namespace slammot::loop_closing {

/// Nearest-neighbour index over surfels, restricted to surfels with a similar normal.
class SurfelIndex {
 public:
  /// `bucket_m`: bucket size and greatest search radius.
  SurfelIndex(std::vector<flow::Surfel> surfels, double bucket_m);

  /// Nearest surfel within `reach_m` (at most `bucket_m`) with a similar normal; null if there is
  /// none. A surfel or query without a normal is similar to all.
  const flow::Surfel* nearest(const Eigen::Vector2f& point_m, const Eigen::Vector2f& normal,
                              float reach_m) const;

  std::span<const flow::Surfel> surfels() const { return surfels_; }

 private:
  std::int32_t column_of(float x_m) const;
  std::int32_t row_of(float y_m) const;

  std::vector<flow::Surfel> surfels_;  ///< Sorted by bucket.
  std::vector<std::uint32_t> first_;   ///< First surfel of each bucket, row-major; plus one at the
                                       ///< end.
  float bucket_m_ = 1.0F;
  float min_x_m_ = 0.0F;
  float min_y_m_ = 0.0F;
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
};

}  // namespace slammot::loop_closing
