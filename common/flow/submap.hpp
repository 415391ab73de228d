#pragma once

#include <cstdint>
#include <vector>

#include "common/flow/absolute_measurements.hpp"
#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::flow {

/// A surfel of a submap: mean of the echoes in one cell and the wall's normal.
struct Surfel {
  float x_m = 0.0F;  ///< In the submap's frame.
  float y_m = 0.0F;
  float normal_x = 0.0F;  ///< Unit length; zero if no direction could be estimated.
  float normal_y = 0.0F;
  float weight = 0.0F;  ///< Number of echoes in the mean.
};

/// A finished local map: only what was seen while it was in use. Cell (column, row) covers [column,
/// column + 1) * cell_size_m + min_x_m of x, and likewise of y; row-major, row 0 has the lowest y.
struct Submap {
  MapId map_id{};
  SubmapId submap_id;
  std::int64_t first_stamp_ns = 0;
  std::int64_t last_stamp_ns = 0;
  geometry::Pose2 odom_from_submap;               ///< Constant since its beginning.
  geometry::UncertainPose2 previous_from_submap;  ///< Odometric constraint to the previous submap;
                                                  ///< identity for the first.
  geometry::Pose2 submap_from_base_at_end;        ///< Vehicle pose at its end.
  double travelled_m = 0.0;                       ///< While it was in use.
  double cell_size_m = 0.0;
  double min_x_m = 0.0;
  double min_y_m = 0.0;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::vector<std::int8_t> so_log_odds;   ///< Lasting evidence of stationary objects, in 1/16 of
                                          ///< log-odds; 0 = unseen.
  std::vector<std::uint8_t> mo_evidence;  ///< Evidence of motion: 0 never, 255 always seen moving.
  std::vector<Surfel> surfels;
  double saliency = 0.0;  ///< Object saliency score, Wang 2004, Eq. (3.11); 0 if not computed.
  std::vector<SubmapFix> fixes{};         ///< At most kMostFixesOfSubmap.
  std::vector<SubmapHeading> headings{};  ///< At most kMostHeadingsOfSubmap.
};

}  // namespace slammot::flow
