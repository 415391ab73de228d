#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace slammot::matching {

/// How much walls bend if beams are laid out with this step. Beams laid out too widely or too
/// narrowly bend every straight wall to the same side, whatever the motion between scans. bend:
/// median over runs of neighbouring echoes of their sagitta over their chord, positive if the
/// middle lies nearer to the scanner than the ends. The field of view is right where it is zero.
/// ranges in metres, NaN for no echo; step_rad > 0. sigma: standard error of the median, by the
/// median deviation of normal errors. windows: number of runs that were measured.
struct WallBend {
  double bend = 0.0;
  double sigma = 0.0;
  std::size_t windows = 0;
};
WallBend wall_bend(std::span<const std::vector<float>> scans, double first_beam_rad,
                   double step_rad);

}  // namespace slammot::matching
