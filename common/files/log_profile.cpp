#include "common/files/log_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace slammot::files {
namespace {

constexpr double kFasterThanWalkingMps = 3.0;
constexpr double kFartherThanHallsM = 25.0;

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

bool sees_all_around(const LogFigures& figures) { return figures.field_of_view_rad > 350.0 / 180.0 * std::numbers::pi; }

}  // namespace

ProfileChoice choose_profile(const LogFigures& figures) {
  const std::string speed = rounded(figures.cruising_speed_mps) + " m/s";
  const std::string range = "9 of 10 echoes within " + rounded(figures.far_range_m) + " m";
  if (figures.cruising_speed_mps > kFasterThanWalkingMps) return {"urban", "the vehicle drives at " + speed + ", " + range};
  if (figures.far_range_m > kFartherThanHallsM) return {"urban", "far echoes as in the open, " + range};
  if (figures.cruising_speed_mps > 0.0) return {"indoor", "the vehicle moves at " + speed + " only, " + range};
  return {"indoor", range};
}

double sweep_s_for(const LogFigures& figures, double profile_sweep_s) {
  constexpr double kSteadySpread = 0.25;
  constexpr double kSlowestScannerS = 0.25;  // slower than this, scans were left out of the log
  const double period_s = figures.scan_period_s;
  if (sees_all_around(figures) && figures.beams > 1 && period_s > 0.0 && period_s < kSlowestScannerS &&
      figures.scan_period_spread < kSteadySpread && figures.has_clock) {
    const double beams = static_cast<double>(figures.beams);
    return period_s * (beams - 1.0) / beams;
  }
  return period_s > 0.0 ? std::min(profile_sweep_s, period_s) : profile_sweep_s;
}

}  // namespace slammot::files
