#pragma once

#include <cstdint>
#include <vector>

#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::flow {

/// A point of a wall as the submap holds it: mean of the echoes in one cell and the wall's normal there.
struct Surfel {
  float x_m = 0.0F;             ///< In the submap's frame.
  float y_m = 0.0F;
  float normal_x = 0.0F;        ///< Unit length, or zero where no direction could be estimated.
  float normal_y = 0.0F;
  float weight = 0.0F;          ///< Echoes in the mean.
};

/// A finished local map: what was seen while the vehicle was in it, and nothing that it took over from the one before.
/// Cell (column, row) covers [column, column + 1) * cell_size_m + min_x_m of x, and so for y; row-major, row 0 lowest y.
struct Submap {
  MapId map_id{};
  SubmapId submap_id;
  std::int64_t first_stamp_ns = 0;
  std::int64_t last_stamp_ns = 0;
  geometry::Pose2 odom_from_submap;                 ///< Fixed at its beginning.
  geometry::UncertainPose2 previous_from_submap;    ///< Odometric constraint to the submap before; identity for the first.
  geometry::Pose2 submap_from_base_at_end;          ///< Where the vehicle left it.
  double travelled_m = 0.0;                         ///< While it was in use.
  double cell_size_m = 0.0;
  double min_x_m = 0.0;
  double min_y_m = 0.0;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::vector<std::int8_t> so_log_odds;             ///< Stationary, what lasts of it: 1/16 of a unit of log-odds each; 0 = not seen.
  std::vector<std::uint8_t> mo_evidence;            ///< Moving: 0 never, 255 always seen moving.
  std::vector<Surfel> surfels;
  double saliency = 0.0;                            ///< Object saliency score, Wang 2004, Eq. (3.11); 0 when not computed.
};

}  // namespace slammot::flow
