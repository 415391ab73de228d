#pragma once

#include <functional>
#include <optional>

namespace slammot::matching {

/// Lateness that grows or shrinks evenly with time, as between two clocks that drift apart.
struct LatenessLine {
  double late_s = 0.0;                ///< In the middle of the time.
  double change_s = 0.0;              ///< From the beginning to the end.
  double error = 0.0;                 ///< Squared, in sigmas,
  double error_without_change = 0.0;  ///< and the least one of a lateness that stays.
  double sigma_change_s = 0.0;        ///< One sigma, by the curve of errors.
};

/// Line with the least error of those near `around_s` that change by at most most_change_s to
/// either side, by a search from coarse to fine. error_of(late_s, change_s): squared error in
/// sigmas. None where the least error is at the border or has no bend.
std::optional<LatenessLine> best_lateness_line(
    const std::function<double(double late_s, double change_s)>& error_of, double around_s,
    double most_change_s);

}  // namespace slammot::matching
