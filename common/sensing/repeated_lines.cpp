#include "common/sensing/repeated_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

#include "common/geometry/order_statistics.hpp"

namespace slammot::sensing {
namespace {

using geometry::Vector2;

constexpr double kNearestLine_m = 1.2;
constexpr double kFarthestLine_m = 30.0;

/// A line in one scan.
struct Sighting {
  Vector2 line_per_m;
  std::size_t scan = 0;
};

/// The line through the echoes of two beams.
Vector2 line_through(const Vector2& one, double one_per_m, const Vector2& other,
                     double other_per_m) {
  return Vector2(one_per_m * other.y() - other_per_m * one.y(),
                 other_per_m * one.x() - one_per_m * other.x()) /
         geometry::cross(one, other);
}

void add_sightings(const InverseScans& scans, std::size_t scan, std::vector<Sighting>& sightings) {
  constexpr double kStraight = 0.03;  // deviation of the middle beam, of the line's inverse
  const std::vector<double>& per_m = scans.per_m[scan];
  const std::size_t chord = scans.beams_within(kChord_rad);
  for (std::size_t beam = 0; beam + chord < per_m.size(); ++beam) {
    const std::size_t middle = beam + chord / 2;
    const std::size_t end = beam + chord;
    if (per_m[beam] == 0.0 || per_m[middle] == 0.0 || per_m[end] == 0.0) continue;
    const Vector2 line =
        line_through(scans.direction[beam], per_m[beam], scans.direction[end], per_m[end]);
    const double off_per_m = std::abs(per_m[middle] - line.dot(scans.direction[middle]));
    if (line.norm() > 1.0 / kFarthestLine_m && line.norm() < 1.0 / kNearestLine_m &&
        off_per_m < kStraight * line.norm())
      sightings.push_back({line, scan});
  }
}

/// Counts the scans that have a line, by the logarithm of its distance and by its bearing.
class LineHistogram {
 public:
  explicit LineHistogram(std::span<const Sighting> sightings) {
    std::vector<std::size_t> newest(scans_.size(), sightings.size());
    for (const Sighting& sighting : sightings) {
      const std::size_t cell = cell_of(sighting.line_per_m);
      if (newest[cell] == sighting.scan) continue;
      newest[cell] = sighting.scan;
      ++scans_[cell];
    }
  }

  /// The line that most scans have, or nearly; left out from now on.
  Vector2 take_most_frequent() {
    std::size_t best = 0;
    std::uint32_t most = 0;
    for (std::size_t cell = 0; cell < scans_.size(); ++cell)
      if (const std::uint32_t scans = scans_around(cell); scans > most) best = cell, most = scans;
    for (const std::size_t cell : around(best)) scans_[cell] = 0;
    return line_of(best);
  }

 private:
  static constexpr double kRow = 0.1;
  static constexpr std::size_t kRows = 34;
  static constexpr std::size_t kColumns = 63;
  static constexpr double kColumn_rad = 2.0 * std::numbers::pi / static_cast<double>(kColumns);

  static std::size_t cell_of(const Vector2& line_per_m) {
    const double bearing_rad = std::atan2(line_per_m.y(), line_per_m.x());
    const double column = std::floor((bearing_rad + std::numbers::pi) / kColumn_rad);
    const double row = std::max(0.0, std::log(line_per_m.norm() * kFarthestLine_m)) / kRow;
    return std::min(kRows - 1, static_cast<std::size_t>(row)) * kColumns +
           static_cast<std::size_t>(column) % kColumns;
  }

  static Vector2 line_of(std::size_t cell) {
    const double row = static_cast<double>(cell / kColumns) + 0.5;
    const double bearing_rad =
        kColumn_rad * (static_cast<double>(cell % kColumns) + 0.5) - std::numbers::pi;
    return std::exp(kRow * row) / kFarthestLine_m *
           Vector2(std::cos(bearing_rad), std::sin(bearing_rad));
  }

  static std::array<std::size_t, 9> around(std::size_t cell) {
    std::array<std::size_t, 9> cells{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::size_t row = std::clamp<std::size_t>(cell / kColumns + i / 3, 1, kRows) - 1;
      cells[i] = row * kColumns + (cell % kColumns + kColumns + i % 3 - 1) % kColumns;
    }
    return cells;
  }

  std::uint32_t scans_around(std::size_t cell) const {
    std::uint32_t scans = 0;
    for (const std::size_t near : around(cell)) scans += scans_[near];
    return scans;
  }

  std::vector<std::uint32_t> scans_ = std::vector<std::uint32_t>(kRows * kColumns, 0);
};

/// Steps to the mean of the lines around, and narrows to where most of them are (mean shift).
RepeatedLine mode_near(const Vector2& line_per_m, std::span<const Sighting> sightings) {
  constexpr int kIterations = 8;
  constexpr double kSigmaOfMedian = 1.4826;
  constexpr double kNarrowest = 0.05;  // relative
  constexpr double kWidest = 0.15;
  RepeatedLine mode{line_per_m, kWidest, 0};
  std::vector<double> off;
  for (int i = 0; i < kIterations; ++i) {
    const Vector2 centre = mode.inverse_per_m;
    const double reach = std::clamp(4.0 * mode.spread, kNarrowest, kWidest);
    Vector2 sum = Vector2::Zero();
    off.clear();
    std::size_t scans = 0;
    std::size_t newest = sightings.size();
    for (const Sighting& sighting : sightings) {
      const Vector2 difference = (sighting.line_per_m - centre) / centre.norm();
      if (difference.norm() > reach) continue;
      sum += sighting.line_per_m;
      scans += std::exchange(newest, sighting.scan) != sighting.scan ? 1 : 0;
      off.push_back(std::abs(difference.dot(centre)) / centre.norm());
    }
    if (off.empty()) return mode;
    mode = {sum / static_cast<double>(off.size()),
            kSigmaOfMedian * geometry::upper_median_in_place(off), scans};
  }
  return mode;
}

}  // namespace

std::size_t InverseScans::beams_within(double angle_rad) const {
  constexpr double kFewest = 4.0;
  return static_cast<std::size_t>(
      std::max(kFewest, std::round(angle_rad / std::abs(beam_step_rad))));
}

std::vector<RepeatedLine> repeated_lines(const InverseScans& scans) {
  constexpr int kMost = 40;
  std::vector<Sighting> sightings;
  for (std::size_t scan = 0; scan < scans.per_m.size(); ++scan)
    add_sightings(scans, scan, sightings);
  LineHistogram histogram(sightings);
  std::vector<RepeatedLine> lines;
  for (int i = 0; i < kMost; ++i)
    lines.push_back(mode_near(histogram.take_most_frequent(), sightings));
  return lines;
}

}  // namespace slammot::sensing
