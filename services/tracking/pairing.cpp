#include "services/tracking/pairing.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/association/assignment.hpp"
#include "common/association/gating.hpp"

namespace slammot::tracking {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using flow::PointLabel;
using flow::Segment;

Matrix2d pose_covariance_at(const Vector2d& point_in_odom_m, const flow::SegmentedScan& scan) {
  const Vector2d point_in_base_m = geometry::inverse(scan.odom_from_base.pose) * point_in_odom_m;
  const geometry::Matrix3 J =
      geometry::compound_jacobian_first(scan.odom_from_base.pose, {point_in_base_m.x(), point_in_base_m.y(), 0.0});
  return (J * scan.odom_from_base.covariance * J.transpose()).topLeftCorner<2, 2>();
}

bool is_backdrop(const Segment& segment, const TrackingConfig& config) {
  return segment.label == PointLabel::kNoEcho ||
         (segment.label != PointLabel::kMoving && segment.box_length_m > config.longest_body_m);
}

/// Where only people move, what is wider than one of them and does not contradict the map stands: a wall, a table. Those who
/// walk past it may still have the part of it that lies in their own place.
bool is_furniture(const Segment& segment, const TrackingConfig& config) {
  constexpr double kWidestOfOneM = 0.7;
  return only_people_move(config) && segment.label != PointLabel::kMoving && segment.box_length_m > kWidestOfOneM;
}

/// The cost of a pair that is not far apart.
double near_pair_cost(const Body& body, const filters::MotionState& motion, const Segment& segment, const TrackingConfig& config) {
  if (is_backdrop(segment, config)) return association::kForbidden;
  if (!body.has_sides && is_furniture(segment, config)) return association::kForbidden;
  const Vector2d position_m = motion.mean.head<2>();
  const Vector2d to_middle_m = segment.centroid_in_odom_m - position_m;
  const double reach_m = config.widest_gate_m + 0.5 * std::hypot(body.length.value_m, body.width.value_m);
  if (to_middle_m.squaredNorm() > reach_m * reach_m) return association::kForbidden;
  const Vector2d residual_m = offset_from_box(body, position_m, 0.0, segment.centroid_in_odom_m);
  Matrix2d S = motion.covariance.topLeftCorner<2, 2>() + segment.centroid_covariance_m2;
  const double shape_m = config.shape_noise_m + config.blob_noise_share * segment.box_length_m;
  S.diagonal().array() += shape_m * shape_m;
  const bool is_inside = residual_m == Vector2d::Zero();  // as most that are near are
  const double distance2 = is_inside ? 0.0 : association::mahalanobis_squared<2>(residual_m, S);
  if (!is_inside && distance2 > association::planar_gate(config.gate_share)) return association::kForbidden;
  const double body_m = std::max(0.5, body.length.value_m);
  const double outgrown_m = std::max(0.0, segment.box_length_m - body.length.value_m - config.gate_margin_m);
  const double larger_cost = body.has_sides ? config.larger_body_cost_per_m * outgrown_m : 0.3 * outgrown_m;
  return distance2 + 0.5 * to_middle_m.squaredNorm() / (body_m * body_m) + std::log(std::sqrt(S.determinant()) / 0.01) +
         larger_cost + (segment.label == PointLabel::kMoving ? 0.0 : config.other_label_cost);
}

double pair_cost(const Body& body, const filters::MotionState& motion, const Segment& segment, const TrackingConfig& config) {
  const double farthest_m = config.widest_gate_m + 0.5 * (body.length.value_m + body.width.value_m);
  const bool is_far = (segment.centroid_in_odom_m - motion.mean.head<2>()).squaredNorm() > farthest_m * farthest_m;
  return is_far ? association::kForbidden : near_pair_cost(body, motion, segment, config);  // most are, and need no root
}

}  // namespace slammot::tracking
