#include "services/tracking/association_cost.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/association/assignment.hpp"
#include "common/association/gating.hpp"
#include "services/tracking/blob.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using flow::PointLabel;
using flow::Segment;

constexpr double kGateShare = 0.999;     ///< Of true pairs that pass the gate.
constexpr double kOtherLabelCost = 4.0;  ///< Of a segment that detection did not label as moving.
constexpr double kLargerBodyCostPerM = 1.0;  ///< Of a segment longer than the box [1/m].

/// Where only people move, a segment wider than a person that does not contradict the map is
/// stationary. Pedestrians may still be assigned the part of it within their own extent.
bool is_furniture(const Segment& segment, const TrackingConfig& config) {
  constexpr double kWidestOfOneM = 0.7;
  return only_people_move(config) && segment.label != PointLabel::kMoving &&
         segment.box_length_m > kWidestOfOneM;
}

/// Covariance of the innovation of the segment's centroid.
Matrix2d innovation_covariance_m2(const filters::MotionState& motion, const Segment& segment,
                                  const TrackingConfig& config) {
  Matrix2d S = motion.covariance.topLeftCorner<2, 2>() + segment.centroid_covariance_m2;
  const double shape_m = config.sensor.shape_noise_m + kBlobNoiseShare * segment.box_length_m;
  S.diagonal().array() += shape_m * shape_m;
  return S;
}

double cost_of_near_pair(const Outline& outline, const filters::MotionState& motion,
                         const Segment& segment, const TrackingConfig& config) {
  if (is_backdrop(segment, config)) return association::kForbidden;
  if (!is_box(outline) && is_furniture(segment, config)) return association::kForbidden;
  const Footprint& footprint = footprint_of(outline);
  const Vector2d position_m = motion.mean.head<2>();
  const Vector2d to_middle_m = segment.centroid_in_odom_m - position_m;
  const double reach_m = config.association.widest_gate_m +
                         0.5 * std::hypot(footprint.length.value_m, footprint.width.value_m);
  if (to_middle_m.squaredNorm() > reach_m * reach_m) return association::kForbidden;
  const Vector2d residual_m = offset_from(footprint, position_m, 0.0, segment.centroid_in_odom_m);
  const Matrix2d S = innovation_covariance_m2(motion, segment, config);
  const bool is_inside = residual_m == Vector2d::Zero();  // the usual case
  const double distance2 = is_inside ? 0.0 : association::mahalanobis_squared<2>(residual_m, S);
  if (!is_inside && distance2 > association::planar_gate(kGateShare))
    return association::kForbidden;
  const double size_m = std::max(0.5, footprint.length.value_m);
  const double excess_m = std::max(
      0.0, segment.box_length_m - footprint.length.value_m - config.association.gate_margin_m);
  const double size_cost = is_box(outline) ? kLargerBodyCostPerM * excess_m : 0.3 * excess_m;
  return distance2 + 0.5 * to_middle_m.squaredNorm() / (size_m * size_m) +
         std::log(std::sqrt(S.determinant()) / 0.01) + size_cost +
         (segment.label == PointLabel::kMoving ? 0.0 : kOtherLabelCost);
}

}  // namespace

Matrix2d pose_covariance_at(const Vector2d& point_in_odom_m, const flow::SegmentedScan& scan) {
  const Vector2d point_in_base_m = geometry::inverse(scan.odom_from_base.pose) * point_in_odom_m;
  const geometry::Matrix3 J = geometry::compound_jacobian_first(
      scan.odom_from_base.pose, {point_in_base_m.x(), point_in_base_m.y(), 0.0});
  return (J * scan.odom_from_base.covariance * J.transpose()).topLeftCorner<2, 2>();
}

bool is_backdrop(const Segment& segment, const TrackingConfig& config) {
  return segment.label == PointLabel::kNoEcho ||
         (segment.label != PointLabel::kMoving &&
          segment.box_length_m > config.extent.longest_body_m);
}

double association_cost(const Outline& outline, const filters::MotionState& motion,
                        const Segment& segment, const TrackingConfig& config) {
  const Footprint& footprint = footprint_of(outline);
  const double farthest_m =
      config.association.widest_gate_m + 0.5 * (footprint.length.value_m + footprint.width.value_m);
  const bool is_far =
      (segment.centroid_in_odom_m - motion.mean.head<2>()).squaredNorm() > farthest_m * farthest_m;
  return is_far ? association::kForbidden : cost_of_near_pair(outline, motion, segment, config);
}

}  // namespace slammot::tracking
