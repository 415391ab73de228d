#include "services/detection/segment_description.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/full_turn.hpp"
#include "common/geometry/uncertain_pose2.hpp"
#include "common/sensing/box_fit.hpp"

namespace slammot::detection {
namespace {

using flow::LocalizedScan;
using flow::PointLabel;
using flow::Segment;
using flow::SegmentedScan;
using geometry::Matrix2;
using geometry::Vector2;

/// A segment is moving if more than this share of its points with known label is; Wang 2004,
/// section 6.2.
constexpr double kMovingShare = 0.5;
constexpr double kOccluderMarginM = 0.5;  ///< A neighbouring echo nearer by more than this occludes
                                          ///< the end of a segment.
constexpr double kRangeNoisePerM = 0.001;  ///< Increase of range_noise_m per metre of range.

double moving_share(const Segment& segment, const SegmentedScan& scan) {
  int moving = 0;
  int decidable = 0;
  for (const std::uint16_t beam : segment.beams) {
    moving += scan.labels[beam] == PointLabel::kMoving ? 1 : 0;
    decidable += scan.labels[beam] == PointLabel::kUnknown ? 0 : 1;
  }
  return decidable == 0 ? 0.0 : static_cast<double>(moving) / decidable;
}

double mean_moving_evidence(const Segment& segment, const LocalizedScan& scan) {
  double sum = 0.0;
  for (const std::uint16_t beam : segment.beams)
    sum += static_cast<double>(scan.beams[beam].moving_evidence);
  return sum / static_cast<double>(segment.beams.size());
}

PointLabel label_of_segment(const Segment& segment, const LocalizedScan& localized,
                            const SegmentedScan& scan) {
  if (segment.moving_share > kMovingShare) return PointLabel::kMoving;
  const bool is_stationary =
      std::any_of(segment.beams.begin(), segment.beams.end(),
                  [&](std::uint16_t beam) { return scan.labels[beam] == PointLabel::kStationary; });
  if (is_stationary) return PointLabel::kStationary;
  const bool has_moving_evidence =
      static_cast<int>(segment.beams.size()) <= kLargestByMovingEvidence &&
      mean_moving_evidence(segment, localized) >= kLeastMovingEvidence;
  return has_moving_evidence ? PointLabel::kMoving : PointLabel::kUnknown;
}

/// True if the nearest echo within two beams in direction `step` (+1 or -1) is clearly nearer than
/// the beam's echo, or if the field of view ends there.
bool is_occluded_beyond(std::uint16_t beam, int step, const SegmentedScan& scan) {
  constexpr int kBeamsLookedAt = 2;
  for (int i = 1; i <= kBeamsLookedAt; ++i) {
    const int count = static_cast<int>(scan.range_m.size());
    int neighbour = static_cast<int>(beam) + i * step;
    if (geometry::goes_all_round(scan.range_m.size(), scan.beam_step_rad))
      neighbour = (neighbour + count) % count;
    if (neighbour < 0 || neighbour >= count) return true;  // end of the field of view
    const double range_m = static_cast<double>(scan.range_m[static_cast<std::size_t>(neighbour)]);
    if (range_m > 0.0) return range_m < static_cast<double>(scan.range_m[beam]) - kOccluderMarginM;
  }
  return false;
}

/// Measurement covariance of one echo in odom [m²], without that of the vehicle's pose.
Matrix2 echo_covariance(const Vector2& way_m, double beam_step_rad, const DetectionConfig& config) {
  const double range_m = std::max(way_m.norm(), 1e-3);
  const Vector2 along = way_m / range_m;
  const double sigma_along_m = config.range_noise_m + kRangeNoisePerM * range_m;
  // Uniformly distributed over the beam's width.
  const double sigma_across_m = range_m * std::abs(beam_step_rad) / std::sqrt(12.0);
  return sigma_along_m * sigma_along_m * along * along.transpose() +
         sigma_across_m * sigma_across_m * (Matrix2::Identity() - along * along.transpose());
}

/// Contribution of the pose's covariance to a point at `lever_in_odom_m` from the vehicle; Wang
/// 2004, Eq. (2.3).
Matrix2 pose_contribution(const geometry::UncertainPose2& odom_from_base,
                          const Vector2& lever_in_odom_m) {
  const geometry::Matrix3 J = geometry::compound_jacobian_first(lever_in_odom_m);
  return (J * odom_from_base.covariance * J.transpose()).topLeftCorner<2, 2>();
}

void describe_shape(Segment& segment, const SegmentedScan& scan, const Matrix2& R,
                    const DetectionConfig& config, std::vector<Vector2>& points_in_odom_m) {
  points_in_odom_m.clear();
  const Vector2 t = scan.odom_from_base.pose.translation_m();
  Vector2 sum = Vector2::Zero();
  for (const std::uint16_t beam : segment.beams) {
    points_in_odom_m.push_back(R * scan.points_in_base_m[beam].cast<double>() + t);
    sum += points_in_odom_m.back();
  }
  const auto count = static_cast<double>(segment.beams.size());
  segment.centroid_in_odom_m = sum / count;
  const Vector2 laser_in_odom_m = R * scan.base_from_laser.translation_m() + t;
  const Vector2 centroid_in_base_m = R.transpose() * (segment.centroid_in_odom_m - t);
  segment.centroid_covariance_m2 =
      echo_covariance(segment.centroid_in_odom_m - laser_in_odom_m, scan.beam_step_rad, config) /
          count +
      pose_contribution(scan.odom_from_base, R * centroid_in_base_m);
  // Only segments that may initiate a track need the heading of the best fit. For the others the
  // line between the end points suffices.
  const Vector2 way = points_in_odom_m.back() - points_in_odom_m.front();
  const sensing::OrientedBox box =
      segment.label == PointLabel::kMoving
          ? sensing::fit_box(points_in_odom_m, config.range_noise_m)
          : sensing::box_at_heading(points_in_odom_m, std::atan2(way.y(), way.x()));
  segment.box_centre_in_odom_m = box.centre_m;
  segment.box_heading_rad = box.heading_rad;
  segment.box_length_m = box.length_m;
  segment.box_width_m = box.width_m;
}

}  // namespace

void describe_segment(Segment& segment, const LocalizedScan& localized,
                      const DetectionConfig& config, const SegmentedScan& scan,
                      const Matrix2& odom_from_base_turn, std::vector<Vector2>& points_in_odom_m) {
  segment.moving_share = moving_share(segment, scan);
  segment.label = label_of_segment(segment, localized, scan);
  segment.occluded_at_start = is_occluded_beyond(segment.beams.front(), -1, scan);
  segment.occluded_at_end = is_occluded_beyond(segment.beams.back(), +1, scan);
  describe_shape(segment, scan, odom_from_base_turn, config, points_in_odom_m);
  if (segment.label == PointLabel::kMoving && segment.box_length_m > config.longest_mover_m)
    segment.label = PointLabel::kUnknown;
}

}  // namespace slammot::detection
