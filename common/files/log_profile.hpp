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

/// Time from the first to the last beam of a scan. For a scanner of more than 200 degrees at a
/// constant rate it follows from the period, as its mirror turns once a scan. Otherwise it is from
/// the profile, limited by the period.
double sweep_s_for(const LogFigures& figures, double profile_sweep_s);

}  // namespace slammot::files
