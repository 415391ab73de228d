#include "services/localization/expected_objects.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::localization {
namespace {

constexpr double kLongestExpectation_s = 1.0;  // tracking that has been silent for longer expects
                                               // nothing any more
constexpr double kBodyMargin_m = 0.1;          // half a cell: echoes come from the sides themselves

/// Where the object is so long after it was published, in odom.
grids::Box box_of(const flow::TrackedObject& object, double after_s, double margin_m) {
  return {object.position_in_odom_m + after_s * object.velocity_in_odom_mps,
          {std::cos(object.heading_in_odom_rad), std::sin(object.heading_in_odom_rad)},
          {0.5 * object.length_m + margin_m, 0.5 * object.width_m + margin_m}};
}

/// Whether a vehicle is seen in the scan of this stamp, has been known for a while, and is surely
/// not at rest.
bool is_surely_moving_vehicle(const flow::TrackedObject& object, std::int64_t stamp_ns) {
  constexpr double kLeastSpeedMps = 1.0;
  constexpr double kSigmas = 3.0;
  constexpr double kLeastKnownS = 0.5;
  constexpr double kShortestVehicleM = 1.5;
  if (!object.confirmed || object.last_seen_ns != stamp_ns || object.length_m < kShortestVehicleM)
    return false;
  const double speed_mps = object.velocity_in_odom_mps.norm();
  const double sigma_mps = std::sqrt(object.covariance.bottomRightCorner<2, 2>().trace());
  return speed_mps >= std::max(kLeastSpeedMps, kSigmas * sigma_mps) &&
         static_cast<double>(stamp_ns - object.first_seen_ns) * 1e-9 >= kLeastKnownS;
}

}  // namespace

void ExpectedObjects::expect(const flow::TrackedObjects& objects) {
  spare_objects_.resize(objects_.objects, objects.objects.size());
  objects_ = objects;
}

const std::vector<grids::Box>& ExpectedObjects::masks_at(std::int64_t stamp_ns) {
  masks_.clear();
  const double after_s = static_cast<double>(stamp_ns - objects_.stamp_ns) * 1e-9;
  if (after_s > kLongestExpectation_s || !config_.echoes.leave_out_moving) return masks_;
  for (const flow::TrackedObject& object : objects_.objects)
    if (object.confirmed && !object.occluded)
      masks_.push_back(box_of(object, after_s, kMaskMarginM));
  return masks_;
}

void ExpectedObjects::drive_over(const flow::ScanLabels& labels, LocalMap& map) const {
  if (objects_.sequence != labels.sequence || objects_.stamp_ns != labels.stamp_ns ||
      !config_.echoes.leave_out_moving)
    return;
  for (const flow::TrackedObject& object : objects_.objects)
    if (is_surely_moving_vehicle(object, labels.stamp_ns))
      map.drive_over(box_of(object, 0.0, kBodyMargin_m));
}

}  // namespace slammot::localization
