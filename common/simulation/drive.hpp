#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/sensing/scan.hpp"
#include "common/simulation/scenario.hpp"

namespace slammot::simulation {

/// A moving object that a scan hit, at the scan's stamp.
struct ObjectTruth {
  int id = 0;                          ///< The same through the whole drive.
  ObjectClass kind = ObjectClass::car;
  BoxSize size;
  geometry::Pose2 world_from_object;   ///< Centre of its box.
  double speed_mps = 0.0;
  int points = 0;                      ///< Beams whose echo came from it.
  double range_m = 0.0;                ///< From the vehicle's centre to its centre.
};

/// One scan with what the wheels said and with the truth, all at the scan's stamp.
struct SimulatedScan {
  sensing::LaserScan scan;
  sensing::Odometry odometry;
  double odometry_speed_mps = 0.0;
  double odometry_yaw_rate_radps = 0.0;
  geometry::Pose2 world_from_base;
  std::vector<ObjectTruth> objects;    ///< Ascending id.
};

/// A simulated drive, one scan after the other.
class Drive {
 public:
  explicit Drive(const ScenarioConfig& scenario);
  ~Drive();
  Drive(Drive&&) noexcept;
  Drive& operator=(Drive&&) noexcept;

  /// The next scan; none after the drive's end.
  std::optional<SimulatedScan> next();

  /// Everything that stands still, in the world frame.
  const Outline& stationary_in_world() const;
  std::size_t scan_count() const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace slammot::simulation
