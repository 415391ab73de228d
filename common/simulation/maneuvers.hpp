#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

/// The simulated motions of Wang 2004, Sections 4.3 to 4.6: a point, seen from a scanner at rest
/// with a noise of 0.1 m. What the text does not say (the sampling period, the phases of the
/// move-stop-move maneuver) is chosen here.
namespace slammot::simulation {

/// (x, y [m], vx, vy [m/s], ax, ay [m/s^2]).
using MotionVector = Eigen::Matrix<double, 6, 1>;

/// True state at a time from the start.
using StateAt = std::function<MotionVector(double time_s)>;

inline constexpr double kManeuverSigmaM = 0.1;   ///< One sigma of a measured position.
inline constexpr double kManeuverPeriodS = 0.1;  ///< Time between measurements.

/// Case 1, Figures 4.2 and 4.3: from 5 m/s with 10 m/s^2.
MotionVector accelerating(double time_s);
/// Case 2, Figures 4.4 and 4.5: 15 m/s.
MotionVector cruising(double time_s);
/// Case 3, Figures 4.6 and 4.7: 15 m/s with 18 degrees a second.
MotionVector turning(double time_s);
/// 0.4 m/s: little above what a stop model takes for standing (Section 4.5).
MotionVector creeping(double time_s);
/// Figures 4.10 to 4.12.
MotionVector standing(double time_s);
/// Case 4, Figures 4.8, 4.9, 4.17 and 4.18: 10 m/s, 5 m/s^2 down to a stop of 5 s, and the same
/// back.
MotionVector moving_stopping_moving(double time_s);

/// When the phases of the move-stop-move maneuver end.
inline constexpr double kBrakesAtS = 2.0;
inline constexpr double kStandsAtS = 4.0;
inline constexpr double kStartsAtS = 9.0;
inline constexpr double kCruisesAtS = 11.0;
inline constexpr double kStopXM = 30.0;

enum class MotionMode : std::uint8_t { kCruises, kManeuvers, kStands };

/// The mode of the motion from this time on.
struct ModeChange {
  double time_s = 0.0;
  MotionMode mode = MotionMode::kCruises;
};

struct Maneuver {
  std::string_view name;
  StateAt state_at;
  double duration_s = 0.0;
  std::vector<ModeChange> changes;  ///< In the order of time, without the mode at the start.
};

/// The motions above.
std::vector<Maneuver> thesis_maneuvers();

/// Positions measured at the periods 1, 2, ... until the duration.
std::vector<Eigen::Vector2d> measured_positions_m(const Maneuver& maneuver, std::uint64_t seed);

}  // namespace slammot::simulation
