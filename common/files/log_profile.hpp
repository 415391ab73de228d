#pragma once

#include <string>

#include "common/files/log_plan.hpp"

namespace slammot::files {

struct ProfileChoice {
  std::string profile;  ///< "urban" or "indoor".
  std::string reason;   ///< Evidence in the log, for printing.
};

/// Profile by speed and ranges: urban for a vehicle faster than pedestrians or for places with far
/// echoes, indoor otherwise. The scanner's maximum range is no criterion: the same scanners are
/// used indoors and outdoors.
ProfileChoice choose_profile(const LogFigures& figures);

/// Time from the first to the last beam of a scan, of a scanner of more than 200 degrees at a
/// constant rate: its mirror turns once a scan. 0 of others, whose log does not tell.
double sweep_s_by_period(const LogFigures& figures);

/// Time from the first to the last beam of a scan: that by the period where the log tells it, else
/// that of the profile, limited by the period.
double sweep_s_for(const LogFigures& figures, double profile_sweep_s);

}  // namespace slammot::files
