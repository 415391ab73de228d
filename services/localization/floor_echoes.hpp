#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/sensing/floor_survey.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::localization {

/// Leaves out the echoes of the floor of a scanner that looks down (sensing::FloorSurvey), for each
/// scanner by itself, from the scan on at which the views so far tell it. A floor beside the
/// vehicle is not told from a wall so early. Of a log it was left out before: nothing is found.
class FloorEchoes {
 public:
  /// To be called once for each scan, in their order. wheel_from_base: odometry at the scan;
  /// without it nothing new is found. The scan, or a copy in which the floor tells nothing; valid
  /// until the next call.
  const sensing::LaserScan& leave_out(const sensing::LaserScan& scan,
                                      const std::optional<geometry::Pose2>& wheel_from_base);

  /// The same of a scan that came before, without learning from it.
  const sensing::LaserScan& without_floor(const sensing::LaserScan& scan);

  /// What was found at the last scan that was given to leave_out().
  const std::optional<sensing::FloorInView>& found_now() const { return found_now_; }

 private:
  /// Numbers of views at which it is looked for; a scanner that saw no floor by then sees none.
  static constexpr std::array<std::size_t, 2> kLooks{32, 64};

  struct Scanner {
    std::string scanner_id;
    sensing::FloorSurvey survey;
    std::size_t looks = 0;  ///< Done.
    sensing::FloorInView floor;

    bool is_decided() const { return looks == kLooks.size(); }
  };

  Scanner& scanner_of(const sensing::LaserScan& scan);
  void look(Scanner& scanner, const sensing::LaserScan& scan);

  std::vector<Scanner> scanners_;
  std::optional<sensing::FloorInView> found_now_;
  sensing::LaserScan cleared_;  ///< Working memory.
};

}  // namespace slammot::localization
