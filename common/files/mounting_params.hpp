#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/files/carmen_record.hpp"
#include "common/geometry/pose2.hpp"
#include "common/sensing/spatial_mounting.hpp"

namespace slammot::files {

/// Mountings of the scanners by the PARAM lines of a log: robot_frontlaser_*, robot_rearlaser_* and
/// robot_laserN_*. None for scanners of bags.
class MountingParams {
 public:
  void add(const ParamRecord& record);

  std::optional<geometry::Pose2> base_from_laser(LaserRecordKind kind, std::uint8_t slot) const;
  sensing::Tilt tilt(LaserRecordKind kind, std::uint8_t slot) const;
  /// Of the front and the rear scanner; 0 if it is not said.
  double max_range_m(std::uint8_t slot) const;

 private:
  struct Mounting {
    std::array<std::optional<double>, 3> offset;  ///< x, y [m], heading [rad].
    sensing::Tilt tilt;
    std::optional<double> max_range_m;

    void set(std::string_view what, double value);
    bool is_told() const { return offset[0] || offset[1] || offset[2]; }
  };

  const Mounting* mounting_of(LaserRecordKind kind, std::uint8_t slot) const;

  std::array<Mounting, 2> named_;     ///< Of the front scanner and of the rear one.
  std::array<Mounting, 9> numbered_;  ///< By slot from 1 on.
};

}  // namespace slammot::files
