#pragma once

#include <string>

#include "common/files/carmen_survey.hpp"

namespace slammot::files {

struct ProfileChoice {
  std::string profile;  ///< "urban" or "indoor".
  std::string reason;   ///< What in the log says so, to be printed.
};

/// The profile that suits what was driven and seen: urban for a vehicle faster than people walk and for places with far
/// echoes, indoor otherwise. The scanner's own reach says nothing: the same scanners are used inside and outside.
ProfileChoice choose_profile(const LogFigures& figures);

/// Time from the first to the last beam of a scan. A scanner that sees all around at a steady rate never rests, so its
/// period says it; of others the profile knows, and no sweep outlasts the period.
double sweep_s_for(const LogFigures& figures, double profile_sweep_s);

}  // namespace slammot::files
