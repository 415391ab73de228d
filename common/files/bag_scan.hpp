#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/bags/ros_messages.hpp"
#include "common/files/carmen_record.hpp"
#include "common/geometry/pose2.hpp"
#include "common/sensing/spatial_mounting.hpp"

namespace slammot::files {

/// Projects a spatial pose to the plane: position seen from above, heading of its x axis.
geometry::Pose2 planar(const bags::Transform& parent_from_child);

/// Mounting of a scanner.
struct Mounting {
  geometry::Pose2 base_from_laser;
  bool is_upside_down = false;  ///< Reverses the order of its beams.
  double tilt_rad = 0.0;        ///< Angle between its scan plane and the base's plane.
};

Mounting mounting_of(const bags::Transform& base_from_laser);

sensing::SpatialMounting in_space(const bags::Transform& base_from_laser);

/// The decimal number of few digits within a few units in the last place of this double, if there
/// is one: undoes the rounding of a heading in a quaternion. Also for wrapped headings.
double heading_as_written(double heading_rad);

/// Exact beam layout from the float32 angles of a LaserScan: an angle within rounding of a simple
/// fraction of degrees, or of a number with up to six decimals, becomes that value. First beam,
/// last beam and step then give the layout as ROBOTLASER1 does. Where the ends agree with the size
/// of the step they decide its sign. nullopt for invalid angles.
std::optional<BeamLayout> layout_of_message(float first_beam_rad, float last_beam_rad,
                                            float stated_step_rad, std::size_t beams);

/// As a record without mounting. nullopt for too few, too many or invalid beams.
std::optional<LaserRecord> record_of(const bags::LaserScanMessage& scan);

/// Why there is no record of a scan: "its angles are impossible (...)".
std::string why_no_record(const bags::LaserScanMessage& scan);

/// Slice of a cloud by heights in the base's frame [m].
struct CloudSlice {
  double from_m = 0.0;
  double to_m = 0.0;
  std::size_t beams = 720;  ///< In a full circle.
};

/// The nearest point of the slice in each direction from the sensor, as the scan of a laser at the
/// sensor's position with the base's heading: its mounting is {x, y, 0}. Directions without a point
/// have range 0.
LaserRecord record_of(const bags::PointCloudMessage& cloud, const bags::Transform& base_from_cloud,
                      const CloudSlice& slice);

}  // namespace slammot::files
