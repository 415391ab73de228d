#include "common/sensing/companions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slammot::sensing {
namespace {

constexpr double kFarthest_m = 4.0;
constexpr double kWidest_m = 1.0;
constexpr double kApart_m = 0.3;  // in range: from one thing to the next
constexpr std::size_t kFewestBeams = 2;
constexpr double kReach_m = 0.6;  // echoes nearer to its anchor are its own
constexpr int kMostScansTouching = 4;
constexpr double kStays_m = 0.4;  // within this of where it began to stay,
constexpr double kLong_m = 2.5;   // while the vehicle moves so far
constexpr int kFewestScans = 5;

/// Infinite without an echo.
double reading(const BeamReadings& scan, std::size_t beam) {
  const double range_m = static_cast<double>(scan.range_m[beam]);
  return range_m > 0.0 && range_m < scan.max_range_m ? range_m
                                                     : std::numeric_limits<double>::infinity();
}

geometry::Vector2 end_of(const BeamReadings& scan, std::size_t beam) {
  const double angle_rad = scan.first_beam_rad + scan.beam_step_rad * static_cast<double>(beam);
  return reading(scan, beam) * geometry::Vector2(std::cos(angle_rad), std::sin(angle_rad));
}

}  // namespace

bool Companions::Candidate::is_companion() const {
  return stayed_over_m >= kLong_m && scans >= kFewestScans;
}

/// Neighbouring beams of about the same range, narrow, with something farther away on either side.
void Companions::find_groups(const BeamReadings& scan) {
  groups_m_.clear();
  const std::size_t beams = scan.range_m.size();
  for (std::size_t first = 0, end = 0; first < beams; first = end) {
    for (end = first + 1;
         end < beams && !(std::abs(reading(scan, end) - reading(scan, end - 1)) > kApart_m);
         ++end) {}
    if (!(reading(scan, first) < kFarthest_m) || end - first < kFewestBeams) continue;
    const bool is_in_front = first > 0 && end < beams &&
                             reading(scan, first - 1) > reading(scan, first) &&
                             reading(scan, end) > reading(scan, end - 1);
    const geometry::Vector2 first_m = end_of(scan, first);
    const geometry::Vector2 last_m = end_of(scan, end - 1);
    if (is_in_front && (last_m - first_m).norm() <= kWidest_m)
      groups_m_.emplace_back(0.5 * (first_m + last_m));
  }
}

bool Companions::is_still_there(Candidate& candidate, const geometry::Pose2& moved) const {
  candidate.stayed_over_m +=
      (geometry::inverse(moved) * candidate.anchor_m - candidate.anchor_m).norm();
  ++candidate.scans;
  ++candidate.scans_since_apart;
  const auto nearest = std::ranges::min_element(groups_m_, {}, [&](const geometry::Vector2& at_m) {
    return (at_m - candidate.last_m).squaredNorm();
  });
  const bool is_apart =
      nearest != groups_m_.end() && (*nearest - candidate.anchor_m).norm() < kStays_m;
  if (is_apart) {
    candidate.last_m = *nearest;
    candidate.scans_since_apart = 0;
  }
  return candidate.scans_since_apart <= (candidate.is_companion() ? kMostScansTouching : 0);
}

void Companions::take_beams_of_companions(const BeamReadings& scan) {
  beams_.clear();
  if (std::ranges::none_of(candidates_, &Candidate::is_companion)) return;
  for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam) {
    if (!(reading(scan, beam) < kFarthest_m + kReach_m)) continue;
    const geometry::Vector2 end_m = end_of(scan, beam);
    if (std::ranges::any_of(candidates_, [&](const Candidate& candidate) {
          return candidate.is_companion() && (end_m - candidate.anchor_m).norm() < kReach_m;
        }))
      beams_.push_back(beam);
  }
}

const std::vector<std::size_t>& Companions::observe(const BeamReadings& scan,
                                                    const geometry::Pose2& moved) {
  find_groups(scan);
  std::erase_if(candidates_,
                [&](Candidate& candidate) { return !is_still_there(candidate, moved); });
  for (const geometry::Vector2& centre_m : groups_m_)
    if (std::ranges::none_of(candidates_, [&](const Candidate& candidate) {
          return (centre_m - candidate.anchor_m).norm() < kStays_m;
        }))
      candidates_.push_back({centre_m, centre_m, 0.0, 1, 0});
  take_beams_of_companions(scan);
  return beams_;
}

}  // namespace slammot::sensing
