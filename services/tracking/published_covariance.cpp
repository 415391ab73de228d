#include "services/tracking/published_covariance.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Variances of a centre in the frame of its box.
struct CentreErrors {
  double along_m2 = 0.0;
  double across_m2 = 0.0;
};

/// Of a box that is, by its class, probably smaller: it is one of the echoes, and the others are of
/// another object.
CentreErrors errors_if_smaller(const Track& track, const TrackingConfig& config) {
  constexpr double kPedestrianM = 0.5;
  CentreErrors errors;
  const Footprint& footprint = track.footprint();
  const auto add_if = [&](double probability, double length_m, double width_m) {
    errors.along_m2 +=
        probability *
        std::pow(
            0.5 * std::max(0.0, footprint.length.value_m - length_m * config.extent.size_scale), 2);
    errors.across_m2 +=
        probability *
        std::pow(0.5 * std::max(0.0, footprint.width.value_m - width_m * config.extent.size_scale),
                 2);
  };
  add_if(track.classification.probability_of(flow::ObjectClass::kPedestrian), kPedestrianM,
         kPedestrianM);
  add_if(track.classification.probability_of(flow::ObjectClass::kBicycle), kKinds[0].length_m,
         kKinds[0].width_m);
  return errors;
}

/// Sigma of a measured centre at the track's range relative to the filter's assumption.
double echo_share(const Track& track, const TrackingConfig& config) {
  const double unneeded_m =
      (1.0 - track.footprint().road_users->shape_share) * config.sensor.range_noise_m;
  return 1.0 - unneeded_m / echo_sigma_m(track.extent.range_m, config);
}

/// Probability that the object is not where its box is, because beams pass through the box or
/// echoes lie off its sides. Counted: docs/decisions/object-covariance.md.
double doubt_of_box(const Track& track, const TrackingConfig& config) {
  constexpr double kUsualPassed = 0.1;  // beside objects a little smaller or turned a little
  constexpr double kIfAllPassed = 0.35;
  constexpr double kUsualOffSides = 2.0;  // sigmas of an echo
  constexpr double kIfFarOff = 0.25;
  const double passed =
      std::max(0.0, (track.existence.passage.share() - kUsualPassed) / (1.0 - kUsualPassed));
  const double usual_m = kUsualOffSides * echo_sigma_m(track.extent.range_m, config);
  const double off =
      std::max(0.0, 1.0 - usual_m / std::max(track.existence.consistency.off_sides_m, 1e-9));
  return std::max(kIfAllPassed * passed, kIfFarOff * off);
}

/// Variance of the heading, with its floor where many scans have the same error.
double common_heading_variance_rad2(const Track& track, const Box& box) {
  constexpr double kByCourseAloneRad = 0.1;  // the course of an emerging object is off alike for
                                             // many scans,
  constexpr double kBySidesRad = 0.01;       // its sides by this much
  constexpr double kMostHeadingRad2 = 0.25;  // a box turned farther is not oriented
  const double of_shape = box.road_users->shape_share;
  const bool is_told_by_sides = box.axis_variance_rad2 <= kKnownAxisRad2;
  const double least_rad = is_told_by_sides ? of_shape * kBySidesRad : kByCourseAloneRad;
  const double noise_share =
      track.extent.heading_noise.share * (is_told_by_sides ? of_shape * of_shape : 1.0);
  return std::clamp(noise_share * box.heading_variance_rad2, least_rad * least_rad,
                    kMostHeadingRad2);
}

/// Added where length and width may be exchanged: the centre then lies farther behind the visible
/// face.
void add_exchange_errors(CentreErrors& errors, const Box& box) {
  constexpr double kTurnedShare = 0.25;
  if (box.is_oriented) return;
  const double off_m2 = kTurnedShare * std::pow(0.5 * (box.length.value_m - box.width.value_m), 2);
  errors.along_m2 += off_m2;
  errors.across_m2 += off_m2 + kTurnedShare * 0.25 * box.length.variance_m2;
}

CentreErrors errors_of_box(const Track& track, const Box& box, const TrackingConfig& config) {
  constexpr double kFaceM = 0.02;  // flatness of the face from which the centre is measured,
  constexpr double kFaceShareOfCorner = 0.15;  // less the rounder its corners are
  constexpr double kFrameOrRiderM = 0.15;  // a bicycle is as wide as its frame or its rider, by the
                                           // height of the scan
  const double of_shape = box.road_users->shape_share;
  const double heading_rad2 = common_heading_variance_rad2(track, box);
  const double corner_m = corner_of(box, box.kind, config).value_m;
  CentreErrors errors = errors_if_smaller(track, config);
  errors.along_m2 +=
      std::pow(of_shape * kFaceM * config.extent.size_scale, 2) +
      std::pow(kFaceShareOfCorner * corner_m, 2) +
      0.25 * (box.length.variance_m2 + heading_rad2 * std::pow(box.width.value_m, 2));
  errors.across_m2 +=
      0.25 * (box.width.variance_m2 + heading_rad2 * std::pow(box.length.value_m, 2));
  if (box.kind == Kind::kBicycle)
    errors.across_m2 += std::pow(kFrameOrRiderM * config.extent.size_scale, 2);
  const double doubt = doubt_of_box(track, config);
  errors.along_m2 += doubt * 0.25 * std::pow(box.length.value_m, 2);
  errors.across_m2 += doubt * 0.25 * std::pow(box.width.value_m, 2);
  add_exchange_errors(errors, box);
  return errors;
}

CentreErrors errors_of_blob(const Track& track, const TrackingConfig& config) {
  constexpr double kHalfACycleM = 0.5;  // of a small fast object perhaps only a wheel or the rider
                                        // is visible
  CentreErrors errors;
  if (!may_be_pedestrian(track))
    errors = {std::pow(kHalfACycleM * config.extent.size_scale, 2),
              std::pow(0.5 * kHalfACycleM * config.extent.size_scale, 2)};
  for (const std::size_t index : {std::size_t{1}, std::size_t{2}}) {  // the visible part may be a
                                                                      // corner of a car or truck
    const KindOfBody& kind = kKinds[index];
    const double probability = track.classification.probability_of(class_of(kind.kind));
    errors.along_m2 += probability * std::pow(0.5 * kind.length_m * config.extent.size_scale, 2);
    errors.across_m2 += probability * std::pow(0.5 * kind.width_m * config.extent.size_scale, 2);
  }
  return errors;
}

}  // namespace

Matrix2d common_error_covariance(const Track& track, double heading_rad,
                                 const TrackingConfig& config) {
  const Box* box = track.extent.box();
  const CentreErrors errors =
      box != nullptr ? errors_of_box(track, *box, config) : errors_of_blob(track, config);
  const Vector2d along{std::cos(heading_rad), std::sin(heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  return errors.along_m2 * along * along.transpose() +
         errors.across_m2 * across * across.transpose();
}

Eigen::DiagonalMatrix<double, 4> noise_factors(const Track& track, const TrackingConfig& config) {
  double share = 1.0;
  if (track.extent.box() != nullptr) share = echo_share(track, config);
  else if (may_be_pedestrian(track))
    share = gait_share(track.kinematics.gait, *track.footprint().road_users, config);
  return Eigen::DiagonalMatrix<double, 4>(share, share, 1.0, 1.0);
}

Eigen::Matrix4d covariance_after(const Eigen::Matrix4d& covariance, double time_s) {
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F.topRightCorner<2, 2>().diagonal().setConstant(time_s);
  return F * covariance * F.transpose();
}

}  // namespace slammot::tracking
