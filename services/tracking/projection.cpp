#include "services/tracking/projection.hpp"

#include <algorithm>
#include <limits>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

struct Spread {
  double least_m = std::numeric_limits<double>::max();
  double most_m = std::numeric_limits<double>::lowest();

  void include(double value_m) {
    least_m = std::min(least_m, value_m), most_m = std::max(most_m, value_m);
  }
  double width_m() const { return most_m - least_m; }
  bool has_in_middle(double value_m) const {
    constexpr double kEndShare = 0.2;
    return value_m >= least_m + kEndShare * width_m() && value_m <= most_m - kEndShare * width_m();
  }
};

/// Mean of the points on a side. Its round ends are left out if enough points remain.
class SideMean {
 public:
  void include(double at_m, bool is_in_middle) {
    sum_m_ += at_m, ++count_;
    if (is_in_middle) middle_sum_m_ += at_m, ++middle_count_;
  }
  double mean_m() const {
    constexpr int kFewestInMiddle = 3;
    return middle_count_ >= kFewestInMiddle ? middle_sum_m_ / middle_count_ : sum_m_ / count_;
  }
  int count() const { return count_; }

 private:
  double sum_m_ = 0.0;
  double middle_sum_m_ = 0.0;
  int count_ = 0;
  int middle_count_ = 0;
};

}  // namespace

Projection span_of(const Observation& observation, const Vector2d& origin_m, const Vector2d& axis) {
  Projection projection;
  projection.low_m = std::numeric_limits<double>::max();
  projection.high_m = std::numeric_limits<double>::lowest();
  const std::size_t count = observation.points_m.size();
  std::size_t lowest = 0;
  std::size_t highest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = axis.dot(observation.points_m[i] - origin_m);
    if (s < projection.low_m) projection.low_m = s, lowest = i;
    if (s > projection.high_m) projection.high_m = s, highest = i;
  }
  const auto edge_beside = [&](std::size_t point) {
    const Edge before = point == 0 ? observation.start : Edge::kOpen;
    return point + 1 == count ? std::max(before, observation.end) : before;
  };
  projection.low_edge = edge_beside(lowest);
  projection.high_edge = edge_beside(highest);
  projection.count = static_cast<int>(count);
  return projection;
}

Projection projection_of(const Observation& observation, const Vector2d& origin_m,
                         const Vector2d& axis, double face_depth_m) {
  Projection projection = span_of(observation, origin_m, axis);
  const double inwards = axis.dot(observation.laser_m - origin_m) < 0.0 ? 1.0 : -1.0;
  const double behind_face_m =
      (inwards > 0.0 ? projection.low_m : -projection.high_m) + face_depth_m;
  const auto across_of = [&](const Vector2d& point) {
    return axis.x() * point.y() - axis.y() * point.x();
  };
  Spread across;
  for (const Vector2d& point : observation.points_m)
    if (inwards * axis.dot(point - origin_m) < behind_face_m) across.include(across_of(point));
  SideMean face;
  for (const Vector2d& point : observation.points_m) {
    const double s = axis.dot(point - origin_m);
    if (inwards * s < behind_face_m) face.include(s, across.has_in_middle(across_of(point)));
  }
  projection.face_m = face.mean_m();
  projection.face_across_m = across.width_m();
  projection.face_count = face.count();
  return projection;
}

Projection mirrored(const Projection& projection) {
  return {-projection.high_m, -projection.low_m,  projection.high_edge,     projection.low_edge,
          projection.count,   -projection.face_m, projection.face_across_m, projection.face_count};
}

}  // namespace slammot::tracking
