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
  int id = 0;                          ///< The same through the whole drive.
  ObjectClass kind = ObjectClass::car;
  BoxSize size;
  geometry::Pose2 world_from_object;   ///< Centre of its box.
  double speed_mps = 0.0;
  int points = 0;                      ///< Beams whose echo came from it.
  double range_m = 0.0;                ///< From the vehicle's centre to its centre.
};

/// What beams hit, where it was no moving object. Ids of objects begin at 1.
constexpr int kHitStationary = 0;
constexpr int kHitNothing = -1;        ///< No echo.
constexpr int kHitSeveral = -2;        ///< Spot split over an edge: the range is of neither surface.

/// One scan with what the wheels said and with the truth, all at the scan's stamp.
struct SimulatedScan {
  std::size_t scanner = 0;             ///< 0: the scenario's first one.
  sensing::LaserScan scan;
  sensing::Odometry odometry;
  double odometry_speed_mps = 0.0;
  double odometry_yaw_rate_radps = 0.0;
  geometry::Pose2 world_from_base;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double nose_down_rad = 0.0;
  std::vector<ObjectTruth> objects;    ///< That it hit.
  std::vector<ObjectTruth> unseen;     ///< In the world, and no beam's echo is theirs.
  std::vector<int> hits;               ///< What each beam hit: an object's id, or one of the above.
  std::vector<sensing::GnssFix> gnss;  ///< With the first scanner's scans only: what came with this scan.
  std::vector<sensing::CompassReading> compass;
};

/// A simulated drive, one scan after the other; those of several scanners by their stamps.
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
  /// Of the first scanner.
  std::size_t scan_count() const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace slammot::simulation
