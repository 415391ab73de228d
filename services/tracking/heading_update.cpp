#include "services/tracking/heading_update.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/pose2.hpp"
#include "services/tracking/extent_update.hpp"

namespace slammot::tracking {
namespace {

using geometry::wrap_angle;

constexpr double kQuarterTurnRad = 0.5 * std::numbers::pi;

/// The axis is modulo a quarter turn: it tells length from width while three sigmas are less than
/// half of one.
constexpr double kTellingAxisRad2 = std::numbers::pi * std::numbers::pi / 144.0;

/// One sigma of the direction of a visible side.
double sigma_rad(const Side& side, double size_scale) {
  constexpr double kEndsOffM = 0.2;  // correlated between scans; short sides are round
  constexpr double kMostSigmaRad = 0.1;
  constexpr double kFlatShare = 0.03;  // a half circle is off its box by a twentieth of its length,
                                       // and has any direction
  constexpr double kRoundRadPerShare = 20.0;
  const double round_rad =
      kRoundRadPerShare * std::max(0.0, side.off_m / side.length_m - kFlatShare);
  return std::hypot(round_rad, std::min(kMostSigmaRad, kEndsOffM * size_scale / side.length_m));
}

/// Turns the box by the gained share of the innovation.
void update_heading(Track& track, double off_rad, double variance_rad2,
                    const Observation& observation, const TrackingConfig& config) {
  const double gain = track.extent.box()->heading_variance_rad2 /
                      (track.extent.box()->heading_variance_rad2 + variance_rad2);
  turn(track, gain * off_rad, observation, config);
  track.extent.box()->heading_variance_rad2 *= 1.0 - gain;
}

/// Turns a box by half or by a quarter if it moves backwards or sideways. False if the course is
/// too uncertain for that.
bool align_with_course(Track& track, const Course& course, const Observation& observation,
                       const TrackingConfig& config) {
  const double off_rad = wrap_angle(course.heading_rad - track.extent.box()->heading_rad);
  if (std::abs(off_rad) > 0.75 * std::numbers::pi) {
    *track.extent.box() = turned_about(*track.extent.box());
  } else if (std::abs(off_rad) > 0.3 * std::numbers::pi) {
    if (course.variance_rad2 > 0.03) return false;
    const Box turned = turned_by_a_quarter(*track.extent.box(), off_rad, config);
    // A box that would be wider than any road user was drawn around several objects.
    redraw(track,
           is_plausible(turned, config) ? turned : box_along_course(track, observation, config),
           observation, config);
  }
  return true;
}

}  // namespace

void follow_side(Track& track, const Observation& observation, double time_s,
                 const TrackingConfig& config) {
  constexpr double kFarthestRad = 0.5;
  if (!observation.side) return;
  Box& box = *track.extent.box();
  // The visible side may be a face or a flank.
  const double off_rad =
      std::remainder(observation.side->heading_rad - box.heading_rad, kQuarterTurnRad);
  const double side_sigma_rad = sigma_rad(*observation.side, config.extent.size_scale);
  const double off_axis_rad =
      std::remainder(observation.side->heading_rad - box.axis_rad, kQuarterTurnRad);
  const double axis_gain =
      box.axis_variance_rad2 / (box.axis_variance_rad2 + side_sigma_rad * side_sigma_rad);
  box.axis_rad = wrap_angle(box.axis_rad + axis_gain * off_axis_rad);
  box.axis_variance_rad2 *= 1.0 - axis_gain;
  if (std::abs(off_rad) > kFarthestRad) return;
  track.extent.heading_noise =
      with_heading(track.extent.heading_noise, off_rad,
                   box.heading_variance_rad2 + side_sigma_rad * side_sigma_rad, time_s);
  update_heading(track, off_rad, side_sigma_rad * side_sigma_rad, observation, config);
}

void follow_course(Track& track, const Observation& observation, double time_s,
                   const TrackingConfig& config) {
  if (track.velocity_mps().norm() < config.extent.box_from_speed_mps) return;
  const Course course = course_of(track.kinematics);
  if (course.variance_rad2 > 0.1) return;
  double off_rad = wrap_angle(course.heading_rad - track.extent.box()->heading_rad);
  const bool is_backwards = std::abs(off_rad) > 0.75 * std::numbers::pi;
  if (!align_with_course(track, course, observation, config)) return;
  off_rad = is_backwards ? wrap_angle(off_rad + std::numbers::pi)
                         : wrap_angle(course.heading_rad - track.extent.box()->heading_rad);
  Box& box = *track.extent.box();
  // Halfway between two sides the course does not tell which of them is the flank.
  const bool knows_axis = box.axis_variance_rad2 < kTellingAxisRad2;
  const double off_axis_rad = std::remainder(course.heading_rad - box.axis_rad, kQuarterTurnRad);
  const bool is_decisive =
      !knows_axis ||
      std::abs(off_axis_rad) + 2.0 * std::sqrt(course.variance_rad2) < 0.5 * kQuarterTurnRad;
  box.is_oriented = box.is_oriented || (is_decisive && course.variance_rad2 < 0.03);
  if (!is_decisive) return;
  const double variance_rad2 = course.variance_rad2 + 0.002;  // the course need not be exactly
                                                              // along the box
  track.extent.heading_noise = with_heading(track.extent.heading_noise, off_rad,
                                            box.heading_variance_rad2 + variance_rad2, time_s);
  update_heading(track, off_rad, variance_rad2, observation, config);
}

void follow_axis(Track& track, double time_s, const TrackingConfig& config) {
  const Box& box = *track.extent.box();
  if (!box.is_oriented || box.axis_variance_rad2 > kTellingAxisRad2) return;
  const double axis_rad =
      box.heading_rad + std::remainder(box.axis_rad - box.heading_rad, kQuarterTurnRad);
  constrain_to_axis(
      track.kinematics,
      {axis_rad, box.axis_variance_rad2, box.axis_variance_rad2 <= kKnownAxisRad2, time_s}, config);
}

}  // namespace slammot::tracking
