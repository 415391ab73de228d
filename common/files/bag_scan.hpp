#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/bags/ros_messages.hpp"
#include "common/files/carmen_record.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::files {

/// A planar pose out of a spatial one: where it is seen from above, and which way its x axis points.
geometry::Pose2 planar(const bags::Transform& parent_from_child);

/// How a scanner is mounted.
struct Mounting {
  geometry::Pose2 base_from_laser;
  bool is_upside_down = false;     ///< Its beams go round the other way.
  double tilt_rad = 0.0;           ///< Of its plane against the base's.
};

Mounting mounting_of(const bags::Transform& base_from_laser);

/// The number with few decimals that is meant by this double, if it is one within a few units in its last place: what a heading
/// loses on its way through a quaternion. Also of headings that were wrapped on that way.
double heading_as_written(double heading_rad);

/// Beams as they are meant by the float32 of a LaserScan: where an angle is within its rounding of whole or simple parts of degrees,
/// or of a number with up to six decimals, it is that; first beam, last beam and step then give the layout as ROBOTLASER1 does.
/// nullopt for angles that make no sense.
std::optional<BeamLayout> layout_of_message(float first_beam_rad, float last_beam_rad, float beam_step_rad, std::size_t beams);

/// As a record, without its mounting. nullopt for a scan of too few or too many beams, or of beams that make no sense.
std::optional<LaserRecord> record_of(const bags::LaserScanMessage& scan);

/// The slice of a cloud that counts, by heights in the base's frame [m].
struct CloudSlice {
  double from_m = 0.0;
  double to_m = 0.0;
  std::size_t beams = 720;          ///< All around.
};

/// The nearest point of the slice in each direction from the sensor, as a scan of a laser that stands at the sensor and is turned
/// as the base is: its mounting is {x, y, 0}. Directions without a point have 0.
LaserRecord record_of(const bags::PointCloudMessage& cloud, const bags::Transform& base_from_cloud, const CloudSlice& slice);

}  // namespace slammot::files
