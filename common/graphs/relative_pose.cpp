#include "common/graphs/relative_pose.hpp"

namespace slammot::graphs {

using geometry::Matrix3;
using geometry::Pose2;

RelativePose relative_pose(const Pose2& map_from_from, const Pose2& map_from_to) {
  RelativePose relative{geometry::inverse(map_from_from) * map_from_to, Matrix3::Zero(),
                        Matrix3::Identity()};
  const Eigen::Matrix2d turn_back = geometry::rotation(-map_from_from.heading_rad);
  relative.by_from.topLeftCorner<2, 2>() = -turn_back;
  relative.by_from(0, 2) = relative.from_to.y_m;
  relative.by_from(1, 2) = -relative.from_to.x_m;
  relative.by_from(2, 2) = -1.0;
  relative.by_to.topLeftCorner<2, 2>() = turn_back;
  return relative;
}

}  // namespace slammot::graphs
