#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::sensing {

/// Inverse ranges of a scanner's scans.
struct InverseScans {
  std::vector<std::vector<double>> per_m;    ///< By scan and beam [1/m]; 0: no echo.
  std::vector<geometry::Vector2> direction;  ///< Of each beam.
  double beam_step_rad = 0.0;

  std::size_t beams_within(double angle_rad) const;
};

/// A line that is at the same place in many scans, seen from the scanner, up to some sway.
struct RepeatedLine {
  geometry::Vector2 inverse_per_m;  ///< Its product with a beam's direction is the inverse range.
  double spread = 0.0;              ///< One sigma of the inverse distance, relative.
  std::size_t scans = 0;            ///< In which it is seen.

  double inverse_distance_per_m() const { return inverse_per_m.norm(); }
};

/// Angle between the outer of the three beams by which a line is seen.
inline constexpr double kChord_rad = 0.15;

/// The lines that most scans have: the modes of a histogram by distance (1.2 to 30 m) and bearing
/// of what three beams see that end on a line.
std::vector<RepeatedLine> repeated_lines(const InverseScans& scans);

}  // namespace slammot::sensing
