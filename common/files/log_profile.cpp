#include "common/files/log_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace slammot::files {
namespace {

constexpr double kFasterThanWalkingMps = 3.0;
constexpr double kFartherThanHallsM = 25.0;
constexpr double kRareScansS = 0.5;  // scans triggered by motion, as robots log them

std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

bool sees_all_around(const LogFigures& figures) {
  return figures.field_of_view_rad > 350.0 / 180.0 * std::numbers::pi;
}

/// From the first to the last beam.
double between_beams_rad(const LogFigures& figures) {
  const double beams = static_cast<double>(figures.beams);
  return beams > 1.0 ? figures.field_of_view_rad * (beams - 1.0) / beams : 0.0;
}

/// Scanners of half a turn are slower than their mirrors: the line to the computer limits them.
bool sees_behind(const LogFigures& figures) {
  return between_beams_rad(figures) > 200.0 / 180.0 * std::numbers::pi;
}

}  // namespace

ProfileChoice choose_profile(const LogFigures& figures) {
  const std::string speed = two_digits(figures.cruising_speed_mps) + " m/s";
  const std::string range = "9 of 10 echoes within " + two_digits(figures.far_range_m) + " m";
  const bool sees_far = figures.far_range_m > kFartherThanHallsM;
  const bool is_fast = figures.has_clock && figures.cruising_speed_mps > kFasterThanWalkingMps;
  if (is_fast) return {"urban", "the vehicle drives at " + speed + ", " + range};
  const bool is_slow = figures.has_clock
                           ? figures.cruising_speed_mps > 0.0 || figures.scan_period_s > kRareScansS
                           : !figures.comes_by_time;
  if (sees_far && is_slow)
    return {"outdoor_robot", "far echoes as in the open and " +
                                 (figures.has_clock ? "a speed of " + speed
                                                    : std::string("a scan for each piece of way")) +
                                 ", " + range};
  if (sees_far) return {"urban", "far echoes as in the open, " + range};
  if (figures.has_clock && figures.cruising_speed_mps > 0.0)
    return {"indoor", "the vehicle moves at " + speed + " only, " + range};
  return {"indoor", range};
}

double sweep_s_by_period(const LogFigures& figures) {
  constexpr double kSteadySpread = 0.25;
  constexpr double kSlowestTurn_s = 0.25;  // a longer period means that the log omits scans
  constexpr double kSlowestWide_s = 0.11;  // of scanners that look farther round than by half
  const double period_s = figures.scan_period_s;
  const bool is_steady = figures.has_clock && figures.beams > 1 && period_s > 0.0 &&
                         figures.scan_period_spread < kSteadySpread;
  if (is_steady && sees_all_around(figures) && period_s < kSlowestTurn_s) {
    const double beams = static_cast<double>(figures.beams);
    return period_s * (beams - 1.0) / beams;
  }
  if (is_steady && sees_behind(figures) && period_s < kSlowestWide_s)
    return period_s * between_beams_rad(figures) / (2.0 * std::numbers::pi);
  return 0.0;
}

double sweep_s_for(const LogFigures& figures, double profile_sweep_s) {
  const double period_s = figures.scan_period_s;
  // A scanner's mirror turns once a scan: with a synthetic period the sweep keeps its share of it.
  if (!figures.has_clock && figures.comes_by_time && profile_sweep_s > 0.0)
    return period_s * figures.field_of_view_rad / (2.0 * std::numbers::pi);
  if (const double sweep_s = sweep_s_by_period(figures); sweep_s > 0.0) return sweep_s;
  return period_s > 0.0 ? std::min(profile_sweep_s, period_s) : profile_sweep_s;
}

}  // namespace slammot::files
