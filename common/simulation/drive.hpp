#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/sensing/aids.hpp"
#include "common/sensing/scan.hpp"
#include "common/simulation/scenario.hpp"

namespace slammot::simulation {

/// A moving object at a scan's stamp.
struct ObjectTruth {
  int id = 0;  ///< Constant over the drive.
  ObjectClass kind = ObjectClass::car;
  BoxSize size;
  geometry::Pose2 world_from_object;  ///< Centre of its box.
  double speed_mps = 0.0;
  int points = 0;        ///< Beams whose echo came from it.
  double range_m = 0.0;  ///< From the vehicle's centre to its centre.
};

/// Source of a beam's echo other than a moving object. Object ids begin at 1.
constexpr int kHitStationary = 0;
constexpr int kHitNothing = -1;  ///< No echo.
constexpr int kHitSeveral = -2;  ///< Spot split over an edge: the range is of neither surface.

/// One scan with odometry and ground truth, all at the scan's stamp.
struct SimulatedScan {
  std::size_t scanner = 0;   ///< 0: the scenario's first one.
  bool is_vertical = false;  ///< A vertical profile.
  sensing::LaserScan scan;
  sensing::Odometry odometry;
  double odometry_speed_mps = 0.0;
  double odometry_yaw_rate_radps = 0.0;
  geometry::Pose2 world_from_base;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double nose_down_rad = 0.0;
  std::vector<ObjectTruth> objects;  ///< Objects with echoes.
  std::vector<ObjectTruth> unseen;   ///< Objects in the world without an echo.
  std::vector<int> hits;  ///< Source of each beam's echo: an object's id, or one of the constants
                          ///< above.
  std::vector<sensing::GnssFix> gnss;  ///< New fixes up to this scan; with the first scanner's
                                       ///< scans only.
  std::vector<sensing::CompassReading> compass;
  std::vector<sensing::TurnRate> turn_rates;  ///< Of the gyro, since the first scanner's last scan.
};

/// A simulated drive, scan by scan; scans of several scanners in order of their stamps.
class Drive {
 public:
  explicit Drive(const ScenarioConfig& scenario);
  ~Drive();
  Drive(Drive&&) noexcept;
  Drive& operator=(Drive&&) noexcept;

  /// The next scan; none after the drive's end.
  std::optional<SimulatedScan> next();

  /// Stationary objects in the world frame.
  const Outline& stationary_in_world() const;
  /// Of the first scanner.
  std::size_t scan_count() const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace slammot::simulation
