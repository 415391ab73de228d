#pragma once

#include <cstddef>

#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Faded counts of the beams between the outermost echoes of an object, and of those without an
/// echo.
struct ResponseRate {
  double missed = 0.0;
  double asked = 0.0;

  /// Share of the beams on the object without an echo, < 1; low before anything is known.
  double unanswered_share() const;
};

/// One scan later: so many echoes, and so many beams between the outermost ones without.
ResponseRate with_responses(ResponseRate responses, std::size_t echoes, int gaps, double time_s);

/// Ratio of the squared innovation of the heading to its variance, averaged: 1 where the filter's
/// noise fits, more in bends and for round or distant objects, less for a long flank on a straight
/// road. Scales the published covariance only.
struct HeadingNoise {
  double share = 1.0;
};

/// One heading measurement later, off_rad from the estimate, with this variance of both together.
HeadingNoise with_heading(const HeadingNoise& before, double off_rad, double variance_rad2,
                          double time_s);

/// Mean distance of the echoes from the sides of a box since it was confirmed.
struct OutlineError {
  double shares = 0.0;  ///< Sum over the echoes of distance / range_noise_m, beyond what grows with
                        ///< range.
  double echoes = 0.0;
  int scans = 0;
};

/// One scan later: echoes at this mean distance from the sides. Scans with few echoes or gross
/// errors are ignored.
OutlineError with_outline(const OutlineError& before, double off_sides_m, std::size_t echoes,
                          double range_m, const TrackingConfig& config);

/// For how long the extent has disagreed with the echoes; each restarts at zero when it agrees [s].
struct MisfitTimes {
  double off_sides_s = 0.0;  ///< The echoes lie off the sides, and only that prevents confirmation.
  double rejected_s = 0.0;   ///< The echoes were rejected as too far from the prediction.
  double oversized_s = 0.0;  ///< A long known pedestrian has been given the echoes of something
                             ///< larger.
};

}  // namespace slammot::tracking
