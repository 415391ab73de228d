#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/sensing/thinned.hpp"

namespace slammot::sensing {

/// Parts of the vehicle in a scanner's view: a mast, a bumper, a cable.
struct OwnBody {
  /// By beam: readings up to this one are echoes of the vehicle; 0 for a beam that looks past it.
  /// Empty: nothing of it is in view. In the unit of the readings.
  std::vector<float> reach;

  std::size_t beams() const;  ///< That see it.

  /// Replaces its echoes by `nothing`. Scans of another number of beams are left as they are.
  void hide(std::span<float> readings, float nothing) const;
};

/// Finds the vehicle's own body in the scans of a drive: what is as far away in nearly all views of
/// a scanner that moves. A view counts when it differs from the last one in many beams.
class OwnBodySurvey {
 public:
  /// Readings of one scan, in any unit; not finite or not positive: no echo. Returns whether they
  /// are another view than the last one.
  bool add(std::span<const float> readings);

  /// unit_m: metres per unit of the readings.
  OwnBody conclude(double unit_m) const;

 private:
  bool is_another_view(std::span<const float> readings) const;

  Thinned<std::vector<float>> views_{256};
  std::vector<float> last_view_;
};

}  // namespace slammot::sensing
