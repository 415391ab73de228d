#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/sensing/thinned.hpp"

namespace slammot::sensing {

/// The floor in the view of a scanner that looks down at it. In the plane of the scan it is a line
/// that goes along with the vehicle.
struct FloorInView {
  /// By beam: readings from this one on are echoes of the floor, or lie beyond it; infinity for a
  /// beam that does not meet it. In the unit of the readings. Empty: it is not left out.
  std::vector<float> from;
  double distance_m = 0.0;      ///< Of the line from the scanner; 0: no floor is in view.
  double bearing_rad = 0.0;     ///< Of its nearest point in the scanner's frame.
  double share_of_views = 0.0;  ///< In which it is seen.
  double share_of_beams = 0.0;  ///< With an echo of something else, over all views.

  bool is_in_view() const { return distance_m > 0.0; }
  bool is_left_out() const { return !from.empty(); }
  bool is_taken_for_wall() const { return is_in_view() && !is_left_out(); }

  /// Replaces its echoes, and what lies beyond, by `nothing`. Scans of another number of beams are
  /// left as they are.
  void hide(std::span<float> readings, float nothing) const;
};

/// True for a line whose nearest point lies at this bearing in base more to the side than ahead or
/// back.
bool lies_beside(double bearing_rad);

/// What the readings of a scanner mean.
struct SurveyedBeams {
  double first_beam_rad = 0.0;
  double beam_step_rad = 0.0;
  double laser_heading_rad = 0.0;                              ///< In base.
  double unit_m = 1.0;                                         ///< Metres per unit of the readings.
  double no_echo_m = std::numeric_limits<double>::infinity();  ///< From this one on.
};

/// Finds the floor in the scans of a drive. Along a beam at the angle a the floor has the inverse
/// range A cos a + B sin a, with the same A and B in all scans, up to the vehicle's pitch and roll.
/// It is told from walls by three properties: many views that differ otherwise have the same line,
/// no echo of its beams lies beyond, and a line beside the vehicle stays there when it turns.
class FloorSurvey {
 public:
  /// Readings of one scan, in any unit; not finite or not positive: no echo. is_another_view: the
  /// readings alone tell that the scanner has moved.
  void add(std::span<const float> readings, const geometry::Pose2& wheel_from_base,
           bool is_another_view);

  /// Of a scan; 0 before the first one.
  std::size_t beams() const {
    return views_.kept().empty() ? 0 : views_.kept().front().readings.size();
  }

  /// That are kept; fewer than 256.
  std::size_t views() const { return views_.kept().size(); }

  FloorInView conclude(const SurveyedBeams& beams) const;

  struct View {
    std::vector<float> readings;
    bool is_in_turn = false;  ///< By odometry since the view before.
  };

 private:
  bool has_moved(const geometry::Pose2& wheel_from_base) const;

  Thinned<View> views_{256};
  geometry::Pose2 last_pose_;
};

}  // namespace slammot::sensing
