#include "common/simulation/maneuvers.hpp"

#include <cmath>
#include <numbers>

#include "common/simulation/random.hpp"

namespace slammot::simulation {
namespace {

MotionVector along_x(double x_m, double speed_mps, double acceleration_mps2) {
  MotionVector state;
  state << x_m, 0.0, speed_mps, 0.0, acceleration_mps2, 0.0;
  return state;
}

}  // namespace

MotionVector accelerating(double t) { return along_x(5.0 * t + 5.0 * t * t, 5.0 + 10.0 * t, 10.0); }

MotionVector cruising(double t) { return along_x(15.0 * t, 15.0, 0.0); }

MotionVector turning(double t) {
  const double rate_radps = 18.0 * std::numbers::pi / 180.0;
  const double angle = rate_radps * t;
  MotionVector state;
  state << 15.0 / rate_radps * std::sin(angle), 15.0 / rate_radps * (1.0 - std::cos(angle)),
      15.0 * std::cos(angle), 15.0 * std::sin(angle), -15.0 * rate_radps * std::sin(angle),
      15.0 * rate_radps * std::cos(angle);
  return state;
}

MotionVector creeping(double t) { return along_x(0.4 * t, 0.4, 0.0); }

MotionVector standing(double) { return MotionVector::Zero(); }

MotionVector moving_stopping_moving(double t) {
  if (t < kBrakesAtS) return along_x(10.0 * t, 10.0, 0.0);
  if (t < kStandsAtS)
    return along_x(kStopXM - 2.5 * (kStandsAtS - t) * (kStandsAtS - t), 5.0 * (kStandsAtS - t),
                   -5.0);
  if (t < kStartsAtS) return along_x(kStopXM, 0.0, 0.0);
  if (t < kCruisesAtS)
    return along_x(kStopXM + 2.5 * (t - kStartsAtS) * (t - kStartsAtS), 5.0 * (t - kStartsAtS),
                   5.0);
  return along_x(kStopXM + 10.0 + 10.0 * (t - kCruisesAtS), 10.0, 0.0);
}

std::vector<Maneuver> thesis_maneuvers() {
  using enum MotionMode;
  return {{"constant acceleration", accelerating, 6.0, {}},
          {"constant velocity", cruising, 6.0, {}},
          {"turn", turning, 10.0, {}},
          {"slow constant velocity", creeping, 6.0, {}},
          {"standing", standing, 6.0, {}},
          {"move-stop-move",
           moving_stopping_moving,
           13.0,
           {{kBrakesAtS, kManeuvers},
            {kStandsAtS, kStands},
            {kStartsAtS, kManeuvers},
            {kCruisesAtS, kCruises}}}};
}

std::vector<Eigen::Vector2d> measured_positions_m(const Maneuver& maneuver, std::uint64_t seed) {
  Random random(seed, Purpose::scanner);
  const long scans = std::lround(maneuver.duration_s / kManeuverPeriodS);
  std::vector<Eigen::Vector2d> positions_m;
  for (long scan = 1; scan <= scans; ++scan) {
    const double x_m = random.normal();
    const double y_m = random.normal();
    const double time_s = static_cast<double>(scan) * kManeuverPeriodS;
    positions_m.emplace_back(maneuver.state_at(time_s).head<2>() +
                             kManeuverSigmaM * Eigen::Vector2d(x_m, y_m));
  }
  return positions_m;
}

}  // namespace slammot::simulation
