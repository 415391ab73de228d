#include "services/tracking/extent.hpp"

#include <algorithm>

#include "common/sensing/box_fit.hpp"

namespace slammot::tracking {

using Eigen::Vector2d;

const Footprint& footprint_of(const Outline& outline) {
  if (const Box* box = std::get_if<Box>(&outline)) return *box;
  return std::get<Blob>(outline);
}

Footprint& footprint_of(Outline& outline) {
  if (Box* box = std::get_if<Box>(&outline)) return *box;
  return std::get<Blob>(outline);
}

bool is_vehicle(const Outline& outline) {
  const Box* box = std::get_if<Box>(&outline);
  return box != nullptr && box->kind != Kind::kBicycle;
}

bool is_plausible(const Outline& outline, const TrackingConfig& config) {
  const Box* box = std::get_if<Box>(&outline);
  return box == nullptr || is_plausible(*box, config);
}

OutlineMeasurement measure(const Outline& outline, const Vector2d& predicted_centre_m,
                           const Observation& observation, const TrackingConfig& config) {
  if (const Box* box = std::get_if<Box>(&outline)) {
    const BoxMeasurement of_box = measure_box(*box, predicted_centre_m, observation, config);
    return {of_box, of_box.box};
  }
  const BlobMeasurement of_blob = measure_blob(std::get<Blob>(outline), observation, config);
  return {of_blob, of_blob.blob};
}

Vector2d seen_centre_m(const Outline& outline, const Vector2d& predicted_centre_m,
                       const Observation& observation, const TrackingConfig& config) {
  if (const Box* box = std::get_if<Box>(&outline))
    return box_centre_m(*box, predicted_centre_m, observation, config);
  return measure_blob(std::get<Blob>(outline), observation, config).centre_m;
}

void store_contour(Extent& extent, const Observation& observation) {
  constexpr std::size_t kMostPoints = 64;
  extent.largest_span_m = std::max(extent.largest_span_m, largest_span_m(observation.points_m));
  const std::size_t stride = 1 + (observation.points_m.size() - 1) / kMostPoints;
  extent.contour_in_odom_m.clear();
  for (std::size_t i = 0; i < observation.points_m.size(); i += stride)
    extent.contour_in_odom_m.push_back(observation.points_m[i].cast<float>());
}

double distance_from_sides_m(const Footprint& footprint, const Vector2d& centre_m,
                             std::span<const Vector2d> points_m) {
  const sensing::BoxSides sides(sensing::OrientedBox{
      centre_m, footprint.heading_rad, footprint.length.value_m, footprint.width.value_m});
  double sum_m = 0.0;
  for (const Vector2d& point_m : points_m) sum_m += sides.distance_m(point_m);
  return sum_m / static_cast<double>(points_m.size());
}

}  // namespace slammot::tracking
