#include "services/evaluator/figures.hpp"

#include <algorithm>
#include <iterator>

namespace slammot::evaluator {

using geometry::Pose2;

const char* colour_of(const std::string& object_class) {
  if (object_class == "pedestrian") return "#c2185b";
  if (object_class == "bicycle") return "#2e8b57";
  if (object_class == "car") return "#d9480f";
  if (object_class == "truck_or_bus") return "#6f42c1";
  return "#7a7a7a";
}

Pose2 pose_near(const metrics::Trajectory& trajectory, std::int64_t stamp_ns) {
  if (trajectory.empty()) return Pose2::identity();
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), stamp_ns,
                       [](const auto& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  if (after == trajectory.end()) return trajectory.back().pose;
  const bool is_before_nearer = after != trajectory.begin() &&
                                stamp_ns - std::prev(after)->stamp_ns < after->stamp_ns - stamp_ns;
  return is_before_nearer ? std::prev(after)->pose : after->pose;
}

}  // namespace slammot::evaluator
