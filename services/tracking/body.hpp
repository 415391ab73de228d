#pragma once

#include <span>

#include <Eigen/Core>

namespace slammot::tracking {

struct TrackingConfig;

/// A size of a body: how long or wide it is believed to be.
struct Size {
  double value_m = 0.0;
  double variance_m2 = 1.0;
};

/// What is known of an object's outline: a box with sides, or a blob without.
struct Body {
  bool has_sides = false;
  double heading_rad = 0.0;           ///< Of the length, in odom.
  double heading_variance_rad2 = 10.0;
  Size length;
  Size width;
};

/// The echoes that belong to one object, in odom.
struct Glimpse {
  std::span<const Eigen::Vector2d> points_m;  ///< In the order of the beams; at least one.
  Eigen::Vector2d laser_m = Eigen::Vector2d::Zero();
  double beam_step_rad = 0.0;                 ///< Positive.
  bool occluded_at_start = false;             ///< Something nearer hides what follows the first
  bool occluded_at_end = false;               ///< or the last point.
};

/// Where a glimpse puts the centre of a body, and what it tells of its size.
struct BodyMeasurement {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
  /// The centre's move when the body is redrawn at its new size with the sides that were seen held fast.
  Eigen::Vector2d recentring_m = Eigen::Vector2d::Zero();
  Body body;                                  ///< With the sizes as now believed.
};

/// Sides that look at the laser fix the body where it is seen; sides that do not follow from its remembered size. An end
/// that something nearer hides fixes nothing, but no body is smaller than what is seen of it.
BodyMeasurement measure_box(const Body& body, const Eigen::Vector2d& predicted_centre_m, const Glimpse& glimpse,
                            const TrackingConfig& config);

/// Middle of the echoes, pushed behind the surface that they lie on by what half the object's depth may be.
BodyMeasurement measure_blob(const Body& body, const Glimpse& glimpse, const TrackingConfig& config);

/// A box of likely size for something of which this much is seen along and across its heading.
Body likely_box(double heading_rad, double heading_variance_rad2, double seen_along_m, double seen_across_m);

/// Largest distance between the points' bounding directions: a quick upper bound of what they span.
double extent_of(std::span<const Eigen::Vector2d> points_m);

/// Vector from the box (zero inside, margins included) to the point.
Eigen::Vector2d offset_from_box(const Body& body, const Eigen::Vector2d& centre_m, double margin_m, const Eigen::Vector2d& point_m);

}  // namespace slammot::tracking
