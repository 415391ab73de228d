#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/sensing/turning_direction.hpp"

namespace slammot::detection {

/// Unit vectors along the beams of a scan, in base. Reuses its memory.
class BeamDirections {
 public:
  void compute(const flow::LocalizedScan& scan) {
    directions_.clear();
    sensing::TurningDirection direction(first_beam_rad(scan), scan.beam_step_rad);
    for (std::size_t i = 0; i < scan.beams.size(); ++i, direction.advance())
      directions_.push_back(direction.now());
  }

  const geometry::Vector2& operator[](std::size_t beam) const { return directions_[beam]; }

 private:
  /// From the first echo; arbitrary in a scan without echoes.
  static double first_beam_rad(const flow::LocalizedScan& scan) {
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      if (scan.beams[i].range_m <= 0.0F) continue;
      const geometry::Vector2 way =
          scan.beams[i].point_in_base_m.cast<double>() - scan.base_from_laser.translation_m();
      return std::atan2(way.y(), way.x()) - static_cast<double>(i) * scan.beam_step_rad;
    }
    return 0.0;
  }

  std::vector<geometry::Vector2> directions_;
};

}  // namespace slammot::detection
