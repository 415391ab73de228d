#include "services/detection/ground.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "services/detection/beam_directions.hpp"

namespace slammot::detection {
namespace {

using geometry::Vector2;

constexpr double kLeastWidthM = 3.0;  ///< Least width of a ground line across the vehicle's axis.
constexpr double kThicknessM = 0.4;   ///< Greatest distance of its echoes from it, along the axis.
constexpr double kHeadingRad = 0.25;  ///< Greatest deviation from a right angle to the axis.
constexpr double kNearestM = 3.0;     ///< Least distance ahead of the scanner.
constexpr double kMaxBeyondShare = 0.2;  ///< Greatest number of beams that see beyond it, as a
                                         ///< share of those on it.

/// x = distance + slope * y, in a frame at the laser parallel to base.
struct Line {
  double distance_m = 0.0;
  double slope = 0.0;
};

enum class Side { kInFront, kOn, kBeyond, kNoEcho, kNotCrossed };

class Ground {
 public:
  Ground(const flow::SegmentedScan& scan, const BeamDirections& directions)
      : scan_(scan), directions_(directions) {}

  Vector2 from_laser_m(std::size_t beam) const {
    return scan_.points_in_base_m[beam].cast<double>() - scan_.base_from_laser.translation_m();
  }

  bool is_candidate(std::size_t beam) const {
    return scan_.labels[beam] == flow::PointLabel::kMoving && from_laser_m(beam).x() > kNearestM;
  }

  /// Least-squares line through a run of candidates; empty if it is not square to the axis.
  std::optional<Line> line_from(std::size_t first, std::size_t last) const {
    double n = 0.0, sy = 0.0, sx = 0.0, syy = 0.0, sxy = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
      if (!is_candidate(i)) continue;
      const Vector2 p = from_laser_m(i);
      n += 1.0, sy += p.y(), sx += p.x(), syy += p.y() * p.y(), sxy += p.x() * p.y();
    }
    const double spread = syy - sy * sy / n;
    const double slope = (sxy - sx * sy / n) / std::max(spread, 1e-9);
    if (std::abs(slope) > std::tan(kHeadingRad)) return std::nullopt;
    return Line{(sx - slope * sy) / n, slope};
  }

  Side side_of(std::size_t beam, const Line& line) const {
    const Vector2& direction = directions_[beam];
    const double approach = direction.x() - line.slope * direction.y();
    constexpr double kMinApproach = 0.2;  // Least rate of approach: a nearly parallel beam meets
                                          // the line too far away.
    if (approach < kMinApproach) return Side::kNotCrossed;
    const double crossing_m = line.distance_m / approach;
    if (crossing_m > 0.9 * scan_.max_range_m) return Side::kNotCrossed;
    const auto range_m = static_cast<double>(scan_.range_m[beam]);
    const double tolerance_m = kThicknessM + 0.02 * crossing_m;
    if (range_m <= 0.0) return Side::kNoEcho;  // asphalt may return no echo
    if (range_m > crossing_m + tolerance_m) return Side::kBeyond;
    return range_m < crossing_m - tolerance_m ? Side::kInFront : Side::kOn;
  }

  /// Beams on the line, and those of all other relations to it.
  struct Tally {
    int on = 0;
    int beyond = 0;
    int without_echo = 0;
    int without_echo_between = 0;  ///< Between the first and the last beam on the line.
    int first = -1;                ///< First beam on the line.
    int last = -1;                 ///< Last beam on the line.
    double low_y_m = 1e9;
    double high_y_m = -1e9;
  };

  Tally tally_of(const Line& line) const {
    Tally tally;
    int without_echo_since_on = 0;
    for (std::size_t i = 0; i < scan_.range_m.size(); ++i) {
      const Side side = side_of(i, line);
      tally.beyond += side == Side::kBeyond ? 1 : 0;
      tally.without_echo += side == Side::kNoEcho ? 1 : 0;
      without_echo_since_on += side == Side::kNoEcho ? 1 : 0;
      if (side != Side::kOn) continue;
      if (tally.on++ == 0) tally.first = static_cast<int>(i);
      else tally.without_echo_between += without_echo_since_on;
      without_echo_since_on = 0;
      tally.last = static_cast<int>(i);
      const double y_m = from_laser_m(i).y();
      tally.low_y_m = std::min(tally.low_y_m, y_m), tally.high_y_m = std::max(tally.high_y_m, y_m);
    }
    return tally;
  }

  /// True if the next beams in direction `step` end in front of the line. A ground line ends at an
  /// occluder; beside a crossing vehicle the beams see beyond it.
  bool ends_at_occluder(int beam, int step, const Line& line) const {
    constexpr int kBeamsLookedAt = 6;
    for (int i = 1; i <= kBeamsLookedAt; ++i) {
      const int neighbour = beam + i * step;
      if (neighbour < 0 || neighbour >= static_cast<int>(scan_.range_m.size())) return true;
      const Side side = side_of(static_cast<std::size_t>(neighbour), line);
      if (side == Side::kInFront || side == Side::kNotCrossed) return true;
      if (side == Side::kBeyond) return false;
    }
    return false;
  }

  bool is_ground(const Line& line) const {
    const Tally tally = tally_of(line);
    if (tally.high_y_m - tally.low_y_m < kLeastWidthM || tally.beyond > kMaxBeyondShare * tally.on)
      return false;
    if (tally.without_echo <= tally.on) return true;
    return tally.without_echo_between <= tally.on && ends_at_occluder(tally.first, -1, line) &&
           ends_at_occluder(tally.last, +1, line);
  }

 private:
  const flow::SegmentedScan& scan_;
  const BeamDirections& directions_;
};

}  // namespace

void find_ground(const flow::SegmentedScan& scan, const BeamDirections& directions,
                 std::vector<char>& is_ground) {
  is_ground.assign(scan.range_m.size(), 0);
  const Ground ground(scan, directions);
  constexpr std::size_t kMinEchoes = 4;
  constexpr std::size_t kMaxEchoes = 12;  // Enough for a line, few enough to follow a curved one.
  for (std::size_t first = 0; first + kMinEchoes <= scan.range_m.size(); ++first) {
    if (is_ground[first] || !ground.is_candidate(first)) continue;
    std::size_t last = first;
    while (last + 1 < scan.range_m.size() && last + 1 < first + kMaxEchoes &&
           ground.is_candidate(last + 1) &&
           std::abs(ground.from_laser_m(last + 1).x() - ground.from_laser_m(last).x()) <
               kThicknessM)
      ++last;
    if (last + 1 < first + kMinEchoes) continue;
    const std::optional<Line> line = ground.line_from(first, last);
    if (line && ground.is_ground(*line)) {
      for (std::size_t i = 0; i < scan.range_m.size(); ++i)
        if (ground.is_candidate(i) && ground.side_of(i, *line) == Side::kOn) is_ground[i] = 1;
    }
    first = last;
  }
}

}  // namespace slammot::detection
