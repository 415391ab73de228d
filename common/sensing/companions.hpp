#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::sensing {

/// Readings of one scan and how its beams lie.
struct BeamReadings {
  std::span<const float> range_m;
  double first_beam_rad = 0.0;
  double beam_step_rad = 0.0;
  double max_range_m = 0.0;  ///< From here on: no echo.
};

/// Finds what goes along with the vehicle close by: somebody who walks ahead of it, a trailer, a
/// mast. In scans it stands still while the vehicle moves, which looks as if the vehicle stood. A
/// companion is a narrow group of echoes in front of what is behind it that stays where it is,
/// seen from the scanner, while odometry moves. Once it is known, it may touch what is behind it
/// for some scans.
class Companions {
 public:
  /// To be called once for each scan, in their order. moved: motion of the vehicle since the scan
  /// before, by odometry. Returns the beams that end on companions, ascending; valid until the next
  /// call.
  const std::vector<std::size_t>& observe(const BeamReadings& scan, const geometry::Pose2& moved);

 private:
  struct Candidate {
    geometry::Vector2 anchor_m;  ///< Where it was when it began to stay, seen from the scanner.
    geometry::Vector2 last_m;    ///< Where it was seen last.
    double stayed_over_m = 0.0;  ///< So far would it have moved meanwhile if it stood in the world.
    int scans = 1;
    int scans_since_apart = 0;  ///< Since it was seen in front of what is behind it.

    bool is_companion() const;
  };

  void find_groups(const BeamReadings& scan);
  bool is_still_there(Candidate& candidate, const geometry::Pose2& moved) const;
  void take_beams_of_companions(const BeamReadings& scan);

  std::vector<geometry::Vector2> groups_m_;  ///< Centres, seen from the scanner.
  std::vector<Candidate> candidates_;
  std::vector<std::size_t> beams_;
};

}  // namespace slammot::sensing
