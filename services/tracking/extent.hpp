#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

#include "services/tracking/blob.hpp"
#include "services/tracking/box.hpp"
#include "services/tracking/box_measurement.hpp"
#include "services/tracking/extent_statistics.hpp"

namespace slammot::tracking {

/// A blob becomes a box once it is large; a box stays one.
using Outline = std::variant<Blob, Box>;

inline bool is_box(const Outline& outline) { return std::holds_alternative<Box>(outline); }

/// The rectangle that both alternatives cover.
const Footprint& footprint_of(const Outline& outline);
Footprint& footprint_of(Outline& outline);

/// True for a box that is not a bicycle.
bool is_vehicle(const Outline& outline);

/// True for every blob, and for a box of a size that occurs on a road.
bool is_plausible(const Outline& outline, const TrackingConfig& config);

struct OutlineMeasurement : CentreMeasurement {
  Outline outline;  ///< With the sizes after the measurement.
};

/// Centre and sizes from one observation.
OutlineMeasurement measure(const Outline& outline, const Eigen::Vector2d& predicted_centre_m,
                           const Observation& observation, const TrackingConfig& config);

/// Centre of an outline of exactly this size.
Eigen::Vector2d seen_centre_m(const Outline& outline, const Eigen::Vector2d& predicted_centre_m,
                              const Observation& observation, const TrackingConfig& config);

/// Size and shape of an object, and how well they fit its echoes.
struct Extent {
  Outline outline;
  std::vector<Eigen::Vector2f> contour_in_odom_m;  ///< Echoes of the last observation, at most 64,
                                                   ///< at its time.
  double largest_span_m = 0.0;                     ///< Largest span of one observation.
  double range_m = 0.0;                            ///< From the laser at the last observation.
  ResponseRate responses;
  HeadingNoise heading_noise;  ///< Of a box.
  OutlineError outline_error;  ///< Of a confirmed box.
  MisfitTimes misfit;

  const Box* box() const { return std::get_if<Box>(&outline); }
  Box* box() { return std::get_if<Box>(&outline); }
  const Blob* blob() const { return std::get_if<Blob>(&outline); }
  Blob* blob() { return std::get_if<Blob>(&outline); }
  const Footprint& footprint() const { return footprint_of(outline); }
  Footprint& footprint() { return footprint_of(outline); }
};

/// Stores at most 64 echoes of the observation as the contour, and its span.
void store_contour(Extent& extent, const Observation& observation);

/// Mean distance of the points from the sides of the rectangle.
double distance_from_sides_m(const Footprint& footprint, const Eigen::Vector2d& centre_m,
                             std::span<const Eigen::Vector2d> points_m);

}  // namespace slammot::tracking
