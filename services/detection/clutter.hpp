#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/flow/segmented_scan.hpp"

namespace slammot::detection {

/// Finds false echoes (rain, dust, cross-talk): in space that the map holds to be free, beams
/// beside which the scanner sees past, so that whatever returned the echo is thinner than a leg,
/// and that had no echo at this place in the previous scan of the scanner. What is thin and real,
/// as the leg of a chair, does not move.
class Clutter {
 public:
  /// Marks in `is_clutter` (one value a beam) the false echoes of the scan, of which points, pose
  /// and beam step are used. Remembers the scan. range_m: 0 for what is no echo.
  void find(const flow::SegmentedScan& scan, const std::vector<float>& range_m,
            std::vector<char>& is_clutter);

 private:
  /// Echoes of the last scan of one scanner.
  struct Earlier {
    std::string scanner_id;
    std::vector<Eigen::Vector2f> echoes_in_odom_m;
  };

  Earlier& earlier_of(const std::string& scanner_id);
  bool was_there(const Earlier& earlier, std::size_t echo, float within_m) const;

  std::vector<Earlier> earlier_;  ///< One a scanner.
  std::vector<Eigen::Vector2f> echoes_in_odom_m_;
};

}  // namespace slammot::detection
