#include "services/tracking/track.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "common/association/gating.hpp"
#include "common/geometry/pose2.hpp"
#include "common/sensing/box_fit.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using geometry::wrap_angle;

/// How fast a body may turn, as a random walk: at one speed, the faster the smaller it is.
double heading_drift_rad2_per_s(const TrackingConfig& config) { return 0.1 / config.size_scale; }

/// The axis of a rectangle is told but for quarters: which of its sides is meant is sure while three sigmas are less than half of one.
constexpr double kTellingAxisRad2 = std::numbers::pi * std::numbers::pi / 144.0;

constexpr double kLeastWayM = 5.0;             ///< What has come so far is no piece of something else: the drive may learn from it.
constexpr double kProgressM = 1.0;             ///< So far something must come once in a while that says to move.

/// What the velocity is known to, in one direction.
double speed_sigma_mps(const Track& track) { return std::sqrt(0.5 * track.velocity_covariance().trace()); }

/// All votes; one that could not decide counts for half.
double weight_of(const MotionEvidence& evidence) { return evidence.moved + evidence.stood + 0.5 * evidence.undecided; }

filters::MoveStopConfig move_stop_config(const TrackingConfig& config) {
  return {config.standing_memory_s, config.detection_sigmas};
}

/// Heading at which the velocity and its covariance point, and how surely.
struct Course {
  double heading_rad = 0.0;
  double variance_rad2 = 10.0;
};

Course course_of(const Track& track) {
  const Vector2d velocity = track.velocity_mps();
  const double speed2 = std::max(velocity.squaredNorm(), 1e-6);
  const Vector2d across{-velocity.y(), velocity.x()};
  return {std::atan2(velocity.y(), velocity.x()), across.dot(track.velocity_covariance() * across) / (speed2 * speed2)};
}

/// The modes in which the track now is.
filters::ModelSet models_of(const Track& track, const TrackingConfig& config) {
  filters::ModelSet set = motion_models(config);
  if (track.cruises_only) set.size = 1;
  if (track.may_turn) set.models[set.size++] = {filters::MotionKind::kCoordinatedTurn, config.turn_noise_density, 0.0};
  return set;
}

/// A turn is linearized about the velocity, which must be well known for that; and what walks or is not yet sure to be anything
/// has no wheels that tie its course to its speed.
bool is_known_to_go_somewhere(const Track& track, const TrackingConfig& config) {
  constexpr double kSlowestMps = 2.0;
  constexpr double kSigmas = 4.0;
  const double variance = 0.5 * track.velocity_covariance().trace();
  return track.confirmed && track.body.has_sides && 
         track.velocity_mps().squaredNorm() > std::max(std::pow(kSlowestMps * config.size_scale, 2), kSigmas * kSigmas * variance);
}

BodyMeasurement measure(const Body& body, const Vector2d& predicted_centre_m, const Observation& observation, const TrackingConfig& config) {
  return body.has_sides ? measure_box(body, predicted_centre_m, observation, config) : measure_blob(body, observation, config);
}

/// Where the echoes put the centre of a body of just this size, whatever they say of the size.
Vector2d seen_centre_m(const Body& body, const Vector2d& predicted_centre_m, const Observation& observation, const TrackingConfig& config) {
  return body.has_sides ? box_centre_m(body, predicted_centre_m, observation, config) : measure_blob(body, observation, config).centre_m;
}

/// Moves the centre, and the places that are remembered of it; the velocity stays. The estimate is the caller's to combine.
void shift(Track& track, const Vector2d& by_m, const filters::ModelSet& models) {
  filters::imm_shift(models, track.motion, by_m);
  filters::move_stop_shift(track.move_stop, by_m);
  track.birth_position_m += by_m;
  track.anchor_m += by_m;
  track.recentred_m += by_m;
  if (track.measured) track.measured->centre_m += by_m;
}

/// Draws the body anew; the sides that are seen stay where they are, so the centre moves and the velocity does not.
void redraw(Track& track, const Body& body, const Observation& observation, const TrackingConfig& config) {
  const Vector2d before_m = seen_centre_m(track.body, track.position_m(), observation, config);
  const BodyMeasurement after = measure(body, supposed_centre_m(body, observation), observation, config);
  const filters::ModelSet models = models_of(track, config);
  track.body = after.body;
  shift(track, after.centre_m - before_m, models);
  track.estimate = filters::imm_combine(models, track.motion);
}

/// Turns the body; what is seen of it stays where it is. Turned about its centre, a long body of which only one end is
/// seen would seem to fly sideways, its course would follow, and its heading that.
void turn(Track& track, double by_rad, const Observation& observation, const TrackingConfig& config) {
  const Vector2d before_m = seen_centre_m(track.body, track.position_m(), observation, config);
  track.body.heading_rad = wrap_angle(track.body.heading_rad + by_rad);
  const Vector2d shift_m = seen_centre_m(track.body, track.position_m(), observation, config) - before_m;
  const filters::ModelSet models = models_of(track, config);
  shift(track, shift_m, models);
  track.estimate = filters::imm_combine(models, track.motion);
}

/// Brings the body's axis, and its heading, to that of the long side that is seen.
void follow_side(Track& track, const Observation& observation, double time_s, const TrackingConfig& config) {
  if (!observation.side) return;
  Body& body = track.body;
  // A rectangle has sides at right angles: it may be a face or a flank.
  const double off_rad = std::remainder(observation.side->heading_rad - body.heading_rad, 0.5 * std::numbers::pi);
  constexpr double kFarthestRad = 0.5;
  constexpr double kEndsOffM = 0.2;  // the errors of one scan are those of the next, and short sides are round
  constexpr double kMostSigmaRad = 0.1;
  constexpr double kFlatShare = 0.03;   // a half circle lies off the sides of its box by a twentieth of its length, and has any heading
  constexpr double kRoundRadPerShare = 20.0;
  const double round_rad = kRoundRadPerShare * std::max(0.0, observation.side->off_m / observation.side->length_m - kFlatShare);
  const double sigma_rad = std::hypot(round_rad, std::min(kMostSigmaRad, kEndsOffM * config.size_scale / observation.side->length_m));
  const double off_axis_rad = std::remainder(observation.side->heading_rad - body.axis_rad, 0.5 * std::numbers::pi);
  const double axis_gain = body.axis_variance_rad2 / (body.axis_variance_rad2 + sigma_rad * sigma_rad);
  body.axis_rad = wrap_angle(body.axis_rad + axis_gain * off_axis_rad);
  body.axis_variance_rad2 *= 1.0 - axis_gain;
  if (std::abs(off_rad) > kFarthestRad) return;
  track.heading_noise = with_heading(track.heading_noise, off_rad, body.heading_variance_rad2 + sigma_rad * sigma_rad, time_s);
  const double gain = body.heading_variance_rad2 / (body.heading_variance_rad2 + sigma_rad * sigma_rad);
  turn(track, gain * off_rad, observation, config);
  body.heading_variance_rad2 *= 1.0 - gain;
}

/// A box around the echoes, along the course where that is known.
Body box_along_course(const Track& track, const Observation& observation, const TrackingConfig& config) {
  const Vector2d way = observation.points_m.back() - observation.points_m.front();
  Body body = likely_box(std::atan2(way.y(), way.x()), observation, config, *track.body.road_users);
  const Course course = course_of(track);
  if (track.velocity_mps().norm() > config.box_from_speed_mps && course.variance_rad2 < 0.05) {
    body = likely_box(course.heading_rad, observation, config, *track.body.road_users);
    if (std::abs(std::cos(body.heading_rad - course.heading_rad)) < 0.7) body = turned_by_a_quarter(body, 1.0, config);
    body.heading_rad = course.heading_rad;
    body.heading_variance_rad2 = course.variance_rad2;
  }
  return body;
}

/// Brings the body's heading to the course. A body that goes backwards or sideways was drawn the wrong way round.
void follow_course(Track& track, const Observation& observation, double time_s, const TrackingConfig& config) {
  if (track.velocity_mps().norm() < config.box_from_speed_mps) return;
  const Course course = course_of(track);
  if (course.variance_rad2 > 0.1) return;
  double off_rad = wrap_angle(course.heading_rad - track.body.heading_rad);
  if (std::abs(off_rad) > 0.75 * std::numbers::pi) {
    track.body = turned_about(track.body);
    off_rad = wrap_angle(off_rad + std::numbers::pi);
  } else if (std::abs(off_rad) > 0.3 * std::numbers::pi) {
    if (course.variance_rad2 > 0.03) return;
    const Body turned = turned_by_a_quarter(track.body, off_rad, config);
    // What would be wider than anything on the road was drawn around several things.
    redraw(track, is_plausible(turned, config) ? turned : box_along_course(track, observation, config), observation, config);
    off_rad = wrap_angle(course.heading_rad - track.body.heading_rad);
  }
  Body& body = track.body;
  // Halfway between a side and the next the course does not tell which of them is the flank.
  const bool knows_axis = body.axis_variance_rad2 < kTellingAxisRad2;
  const double off_axis_rad = std::remainder(course.heading_rad - body.axis_rad, 0.5 * std::numbers::pi);
  const bool is_decisive = !knows_axis || std::abs(off_axis_rad) + 2.0 * std::sqrt(course.variance_rad2) < 0.25 * std::numbers::pi;
  body.is_oriented = body.is_oriented || (is_decisive && course.variance_rad2 < 0.03);
  if (!is_decisive) return;
  const double variance_rad2 = course.variance_rad2 + 0.002;  // wheels do not always roll where the body points
  track.heading_noise = with_heading(track.heading_noise, off_rad, body.heading_variance_rad2 + variance_rad2, time_s);
  const double gain = body.heading_variance_rad2 / (body.heading_variance_rad2 + variance_rad2);
  turn(track, gain * off_rad, observation, config);
  body.heading_variance_rad2 *= 1.0 - gain;
}

/// What is longer than any front or rear of what it would have to be is a flank, though the course has not shown it.
void lie_along_what_is_seen(Track& track, const Observation& observation, const TrackingConfig& config) {
  constexpr double kWidestCarM = 2.1;
  const Body& body = track.body;
  if (body.is_oriented || body.width_evidence.least_m < kWidestCarM * config.size_scale) return;
  const Body turned = turned_by_a_quarter(body, 1.0, config);
  if (!is_plausible(turned, config) || log_evidence_of_sizes(turned, config) - log_evidence_of_sizes(body, config) < kSureOdds) return;
  redraw(track, turned, observation, config);
}

/// Brings the velocity to the length of the body, as the sides alone tell it: wheels do not go sideways. In a curve the sides
/// turn at once, and the course only after the filter has seen that the middle goes elsewhere. An axis of which no side tells just
/// now is off alike in all the scans since one did: they count for one in each fifth of a second.
void steer(Track& track, double time_s, const TrackingConfig& config) {
  constexpr double kUnseenAxisS = 0.2;
  const Body& body = track.body;
  if (!body.is_oriented || body.axis_variance_rad2 > kTellingAxisRad2) return;
  const double scans = body.axis_variance_rad2 > kKnownAxisRad2 ? std::max(1.0, kUnseenAxisS / time_s) : 1.0;
  const double heading_rad = body.heading_rad + std::remainder(body.axis_rad - body.heading_rad, 0.5 * std::numbers::pi);
  const Vector2d across{-std::sin(heading_rad), std::cos(heading_rad)};
  const double variance = track.velocity_mps().squaredNorm() * (kSlip * kSlip + scans * body.axis_variance_rad2) + std::pow(kSlipMps * config.size_scale, 2);
  const filters::ModelSet models = models_of(track, config);
  track.motion = filters::imm_update_speed(models, track.motion, across, 0.0, variance);
  track.estimate = filters::imm_combine(models, track.motion);
}

/// Gives sides to a blob that has become large.
void draw_sides_when_known(Track& track, const Observation& observation, const TrackingConfig& config) {
  if (track.body.has_sides || track.largest_extent_m < config.box_from_extent_m || is_known_pedestrian(track)) return;
  redraw(track, box_along_course(track, observation, config), observation, config);
}

void update_motion_state(Track& track, const TrackingConfig& config) {
  const double step_m = (track.position_m() - track.anchor_m).norm();
  if (step_m > kProgressM * config.size_scale) {
    track.travelled_m += std::min(step_m, 2.0 * kProgressM * config.size_scale);  // what jumps farther was not the same thing
    track.anchor_m = track.position_m();
    track.claimed_travel_m = 0.0;
    track.without_progress_s = 0.0;
  }
  const double speed = track.velocity_mps().norm();
  if (speed < config.stopped_below_mps) track.state = flow::Motion::kStopped;
  if (speed > config.moving_above_mps) track.state = flow::Motion::kMoving;
}

/// Speeds count once the track is that of something, and while they are known and not none.
bool has_known_speed(const Track& track, const TrackingConfig& config) {
  const bool is_known = track.confirmed && !track.is_refuted && speed_sigma_mps(track) < config.most_speed_sigma_mps;
  return is_known && !track.move_stop.stands && track.state == flow::Motion::kMoving;
}

void update_class(Track& track, double time_s, const TrackingConfig& config) {
  constexpr double kLongestHeldS = 0.2;
  if (has_known_speed(track, config))
    track.speeds = with_speed(track.speeds, {track.velocity_mps().norm(), speed_sigma_mps(track), std::min(time_s, kLongestHeldS)}, config);
  track.class_probability = class_probabilities(track.body, track.speeds, config);
  track.object_class = likeliest_class(track.class_probability);
}

void remember_contour(Track& track, const Observation& observation) {
  constexpr std::size_t kMostPoints = 64;
  const std::size_t stride = 1 + (observation.points_m.size() - 1) / kMostPoints;
  track.contour_in_odom_m.clear();
  for (std::size_t i = 0; i < observation.points_m.size(); i += stride)
    track.contour_in_odom_m.push_back(observation.points_m[i].cast<float>());
}

/// Legs swing about the middle of who walks on them, the same way for many scans.
bool may_be_pedestrian(const Track& track) {
  return is_known_pedestrian(track) || (!track.body.has_sides && track.largest_extent_m < 1.0 && track.velocity_mps().norm() < kFastestWalkMps);
}

/// Times which the noise of a centre so far off counts, if it is of somebody known to walk: they are given echoes of others now and
/// then, and their errors have the tails of Student's t, whose weight for a centre is the inverse of this (Lange 1989).
double times_noise(double distance2) {
  constexpr double kDegreesOfFreedom = 4.0;
  return std::max(1.0, (kDegreesOfFreedom + distance2) / (kDegreesOfFreedom + 2.0));
}

/// Variances of a centre in the frame of its body.
struct CentreErrors {
  double along_m2 = 0.0;
  double across_m2 = 0.0;
};

/// Of what is drawn with sides and, by its speed, is likely smaller: it is one of its echoes, and the others are of something else.
CentreErrors errors_if_smaller(const Track& track, const TrackingConfig& config) {
  constexpr double kWalkerM = 0.5;
  CentreErrors errors;
  const auto add_if = [&](double probability, double length_m, double width_m) {
    errors.along_m2 += probability * std::pow(0.5 * std::max(0.0, track.body.length.value_m - length_m * config.size_scale), 2);
    errors.across_m2 += probability * std::pow(0.5 * std::max(0.0, track.body.width.value_m - width_m * config.size_scale), 2);
  };
  add_if(track.class_probability[0], kWalkerM, kWalkerM);
  add_if(track.class_probability[1], kKinds[0].length_m, kKinds[0].width_m);
  return errors;
}

/// With one more scan. Of a few echoes the box is drawn through each.
OutlineError with_scan(const OutlineError& before, double off_sides_m, std::size_t echoes, double range_m, const TrackingConfig& config) {
  constexpr std::size_t kFewest = 6;
  constexpr double kMostShare = 2.0;  // what is farther off is no side of it
  const double share = std::max(0.0, off_sides_m - config.range_noise_per_m * range_m) / config.range_noise_m;
  if (echoes < kFewest || share > kMostShare) return before;
  const double weight = static_cast<double>(echoes);
  return {before.shares + weight * share, before.echoes + weight, before.scans + 1};
}

/// Of what a measured centre is taken to err by, so much it does here, at the range of the track.
double echo_share(const Track& track, const TrackingConfig& config) {
  const double unneeded_m = (1.0 - track.body.road_users->shape_share) * config.range_noise_m;
  return 1.0 - unneeded_m / echo_sigma_m(track.range_m, config);
}

/// How likely something is not there as it is drawn, for beams go through where it should be, or echoes lie off its sides by much
/// more than they err. Counted: decision 45.
double doubt_of_box(const Track& track, const TrackingConfig& config) {
  constexpr double kUsualPassed = 0.1;      // beside bodies that are a little smaller, or turned a little
  constexpr double kIfAllPassed = 0.35;
  constexpr double kUsualOffSides = 2.0;    // times what echoes are taken to err by
  constexpr double kIfFarOff = 0.25;
  const double passed = std::max(0.0, (track.beam_passage.share() - kUsualPassed) / (1.0 - kUsualPassed));
  const double usual_m = kUsualOffSides * echo_sigma_m(track.range_m, config);
  const double off = std::max(0.0, 1.0 - usual_m / std::max(track.consistency.off_sides_m, 1e-9));
  return std::max(kIfAllPassed * passed, kIfFarOff * off);
}

CentreErrors errors_of_box(const Track& track, const TrackingConfig& config) {
  constexpr double kFaceM = 0.02;             // so flat is the front or rear from which the middle is measured,
  constexpr double kFaceShareOfCorner = 0.15; // and the less the rounder its corners are
  constexpr double kByCourseAloneRad = 0.1;   // the course of what comes out from behind something is off alike for many scans,
  constexpr double kBySidesRad = 0.01;        // and its sides, by so much
  constexpr double kMostHeadingRad2 = 0.25;   // what is turned farther off is not oriented
  constexpr double kFrameOrRiderM = 0.15;     // a bicycle is as wide as its frame or as who rides it, by the height of the scan
  const Body& body = track.body;
  const double of_shape = body.road_users->shape_share;
  const bool is_told_by_sides = body.axis_variance_rad2 <= kKnownAxisRad2;
  const double least_rad = is_told_by_sides ? of_shape * kBySidesRad : kByCourseAloneRad;
  const double heading_noise = track.heading_noise.share * (is_told_by_sides ? of_shape * of_shape : 1.0);
  const double heading_rad2 = std::clamp(heading_noise * body.heading_variance_rad2, least_rad * least_rad, kMostHeadingRad2);
  const double corner_m = corner_of(body, body.kind, config).value_m;
  CentreErrors errors = errors_if_smaller(track, config);
  errors.along_m2 += std::pow(of_shape * kFaceM * config.size_scale, 2) + std::pow(kFaceShareOfCorner * corner_m, 2) + 0.25 * (body.length.variance_m2 + heading_rad2 * std::pow(body.width.value_m, 2));
  errors.across_m2 += 0.25 * (body.width.variance_m2 + heading_rad2 * std::pow(body.length.value_m, 2));
  if (body.kind == Kind::kBicycle) errors.across_m2 += std::pow(kFrameOrRiderM * config.size_scale, 2);
  const double doubt = doubt_of_box(track, config);  // then it is anywhere in the box
  errors.along_m2 += doubt * 0.25 * std::pow(body.length.value_m, 2);
  errors.across_m2 += doubt * 0.25 * std::pow(body.width.value_m, 2);
  if (!body.is_oriented) {  // of a face that is taken for a flank the middle lies farther behind
    constexpr double kTurnedShare = 0.25;
    const double off_m2 = kTurnedShare * std::pow(0.5 * (body.length.value_m - body.width.value_m), 2);
    errors.along_m2 += off_m2;
    errors.across_m2 += off_m2 + kTurnedShare * 0.25 * body.length.variance_m2;
  }
  return errors;
}

CentreErrors errors_of_blob(const Track& track, const TrackingConfig& config) {
  constexpr double kHalfACycleM = 0.5;  // of something small and fast only a wheel or the rider may be seen
  CentreErrors errors;
  if (!may_be_pedestrian(track)) errors = {std::pow(kHalfACycleM * config.size_scale, 2), std::pow(0.5 * kHalfACycleM * config.size_scale, 2)};
  // All that shows of a vehicle may be a corner.
  static const std::array<std::pair<std::size_t, KindOfBody>, 2> kVehicles = {{{2, kKinds[1]}, {3, kKinds[2]}}};  // by the entries of class_probability
  for (const auto& [entry, kind] : kVehicles) {
    errors.along_m2 += track.class_probability[entry] * std::pow(0.5 * kind.length_m * config.size_scale, 2);
    errors.across_m2 += track.class_probability[entry] * std::pow(0.5 * kind.width_m * config.size_scale, 2);
  }
  return errors;
}

/// What is wrong with the centre in many scans alike, so that the filter, for which errors are new in each, does not see it:
/// the size that is assumed, the heading along which the middle is sought behind the sides that are seen, and how far the shape is
/// from a box.
Matrix2d shared_error_covariance(const Track& track, double heading_rad, const TrackingConfig& config) {
  const CentreErrors errors = track.body.has_sides ? errors_of_box(track, config) : errors_of_blob(track, config);
  const Vector2d along{std::cos(heading_rad), std::sin(heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  return errors.along_m2 * along * along.transpose() + errors.across_m2 * across * across.transpose();
}

/// Position and velocity so much later, at this velocity.
Eigen::Matrix4d covariance_after(const Eigen::Matrix4d& covariance, double time_s) {
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F.topRightCorner<2, 2>().diagonal().setConstant(time_s);
  return F * covariance * F.transpose();
}

/// How far who walks is off the middle of what is seen of them, as a share of the deviation that the settings take for it: as they
/// were seen to, and before that as those here do.
double swing_share(const Track& track, const TrackingConfig& config) {
  if (config.gait_noise_m <= 0.0) return 1.0;
  return track.gait.variance_m2 ? std::sqrt(*track.gait.variance_m2) / config.gait_noise_m : track.body.road_users->swing_share;
}

/// What the deviations of position and velocity are multiplied with, since the filter takes everybody to swing as legs do, and
/// echoes to err alike in all drives.
Eigen::DiagonalMatrix<double, 4> with_own_errors(const Track& track, const TrackingConfig& config) {
  if (track.body.has_sides) {
    const double share = echo_share(track, config);
    return Eigen::DiagonalMatrix<double, 4>(share, share, 1.0, 1.0);
  }
  const double share = may_be_pedestrian(track) ? swing_share(track, config) : 1.0;
  return Eigen::DiagonalMatrix<double, 4>(share, share, 1.0, 1.0);
}

/// Three seconds ahead by the mixture of modes; who is held to stand may start off as any mode says, and is not known to.
void predict_path(const Track& track, const Matrix2d& shared_error_m2, const TrackingConfig& config, std::vector<flow::PredictedPosition>& path) {
  constexpr std::size_t kSteps = 6;
  constexpr double kStepS = 0.5;
  const filters::ModelSet models = models_of(track, config);
  filters::ImmState now = track.motion;
  if (track.move_stop.stands) now.modes.fill(filters::estimate_of(track.move_stop, track.estimate));
  std::array<filters::Gaussian<2>, kSteps> foretold;
  filters::imm_foretell(models, now, kStepS, foretold);
  for (const filters::Gaussian<2>& there : foretold) {
    const double after_s = kStepS * static_cast<double>(path.size() + 1);
    path.push_back({after_s, there.mean, there.covariance + shared_error_m2});
  }
}

/// Of points from the sides of the body, in the mean.
double distance_from_sides_m(const Track& track, std::span<const Vector2d> points_m) {
  const sensing::BoxSides sides(sensing::OrientedBox{track.position_m(), track.body.heading_rad, track.body.length.value_m, track.body.width.value_m});
  double sum_m = 0.0;
  for (const Vector2d& point_m : points_m) sum_m += sides.distance_m(point_m);
  return sum_m / static_cast<double>(points_m.size());
}

Consistency with_scan(const Consistency& before, double off_sides_m, double nis, double time_s) {
  constexpr double kMemoryS = 0.4;
  constexpr double kMostSurprise2 = 50.0;  // so that one scan does not count for all
  const double kept = std::exp(-time_s / kMemoryS) * before.weight;
  return {(kept * before.off_sides_m + off_sides_m) / (kept + 1.0), (kept * before.nis + std::min(nis, kMostSurprise2)) / (kept + 1.0), kept + 1.0};
}

/// Whether the echoes do not lie on the sides of the body.
bool echoes_lie_off_sides(const Track& track, const TrackingConfig& config) {
  constexpr double kMostM = 0.2;
  return track.body.has_sides && track.consistency.off_sides_m > kMostM * config.size_scale;
}

/// Whether the echoes neither lie on the sides of the body nor come from where it was predicted.
bool is_inconsistent(const Track& track, const TrackingConfig& config) {
  constexpr double kMostSurprise2 = 2.5;  // of two in the mean where the prediction is as good as it says
  return echoes_lie_off_sides(track, config) && track.consistency.nis > kMostSurprise2;
}

/// Whether a vehicle whose velocity was unknown a moment ago comes from elsewhere than it should: what came out may be another one.
bool is_doubted(const Track& track) {
  constexpr double kMostSurprise2 = 4.0;  // twice what is expected
  constexpr std::int64_t kLongestNs = 1'000'000'000;
  const bool is_known_again = track.velocity_known_since_ns != 0 && track.last_seen_ns - track.velocity_known_since_ns < kLongestNs;
  return is_vehicle(track) && is_known_again && track.consistency.nis > kMostSurprise2;
}

/// Where it was when it was first seen. What it was held to be then may have told nothing of where its middle is: the oldest glimpse
/// that is kept is measured by the body that it has by now, if that is surer.
MeasuredCentre birth_of(const Track& track, const TrackingConfig& config) {
  const MeasuredCentre then{track.birth_position_m, track.birth_covariance_m2};
  if (!track.body.has_sides || track.observations.size() == 0) return then;
  const Observation observation = track.observations[0].with_points();
  const BodyMeasurement measured = measure_box(track.body, supposed_centre_m(track.body, observation), observation, config);
  return measured.covariance_m2.trace() < then.R.trace() ? MeasuredCentre{measured.centre_m - measured.recentring_m, measured.covariance_m2} : then;
}

/// Whether it is somewhere else than where it was when it was first seen.
bool has_travelled(const Track& track, const TrackingConfig& config) {
  const MeasuredCentre birth = birth_of(track, config);
  const Vector2d travel_m = track.position_m() - birth.centre_m;
  const double distance_m = travel_m.norm();
  const Vector2d way = travel_m / std::max(distance_m, 1e-6);
  const double sigma_m = std::sqrt(way.dot((track.position_covariance_m2() + birth.R) * way));
  // A jump is no way: what answers now here, now there, like glass or the legs of chairs, would have come far at once.
  const double covered_m = distance_m - (may_be_pedestrian(track) ? track.innovation_m : 0.0);
  return covered_m >= config.least_travel_m && covered_m >= config.least_travel_sigmas * sigma_m;
}

/// Whether its speed can be told from none: what comes into view bit by bit, or was drawn at a stray echo first, seems to have come
/// from somewhere, and stands.
bool is_surely_fast(const Track& track, const TrackingConfig& config) {
  constexpr double kOfSwingingLegs = 0.75;  // who walks is followed with the swing of the legs in the covariance, a post has none
  const double sigmas = config.detection_sigmas * (may_be_pedestrian(track) ? kOfSwingingLegs : 1.0);
  return track.velocity_mps().norm() >= filters::minimum_detection_speed_mps(track.estimate, sigmas);
}

/// Whether the velocity is known well enough for the track to be confirmed. Of what is out of nowhere, and comes as predicted, as
/// well as is published suffices.
bool has_known_velocity(const Track& track, const TrackingConfig& config) {
  constexpr double kMostSurprise2 = 2.0;  // so much is expected where the filter knows as well as it claims
  const bool is_as_predicted = track.consistency.weight > 0.0 && track.consistency.nis < kMostSurprise2 && appeared_in_free_space(track, config);
  const double most_mps = is_as_predicted ? std::max(config.most_speed_sigma_mps, config.most_speed_sigma_published_mps) : config.most_speed_sigma_mps;
  return speed_sigma_mps(track) <= most_mps;
}

/// Whether all tells that it moves, whatever its body is drawn like.
bool moves_by_all_signs(const Track& track, const TrackingConfig& config) {
  const MotionEvidence& evidence = track.evidence;
  // What comes out from behind others is where no earlier scan could see: its echoes are undecided, most of them. Where the map says
  // that it has come, a single vote tells that it is not the map that errs: walls that it holds to be free have none.
  constexpr double kLeastVotes = 0.5;  // one, half forgotten
  const bool has_moved = (evidence.moved >= config.least_moved_votes &&
                          evidence.moved >= config.least_moved_share * weight_of(evidence)) ||
                         (evidence.moved > kLeastVotes && appeared_in_free_space(track, config));
  // Nothing that stands comes to be where the beams went through a moment before.
  const bool has_arrived = evidence.moved >= config.sure_moved_votes &&
                           evidence.moved >= config.sure_moved_share * weight_of(evidence);
  return track.hits >= config.least_hits && track.score >= config.confirm_score && has_moved && has_known_velocity(track, config) &&
         is_surely_fast(track, config) && (has_arrived || has_travelled(track, config));
}

/// A new track in the memory of one that has ended.
Track emptied(Track done_with) {
  Track track;
  track.contour_in_odom_m = std::move(done_with.contour_in_odom_m);
  track.observations = std::move(done_with.observations);
  track.past = std::move(done_with.past);
  track.contour_in_odom_m.clear();
  track.observations.clear();
  track.past.clear();
  return track;
}

void observe(Track& track, std::int64_t stamp_ns, const Observation& observation) {
  ++track.hits;
  track.last_seen_ns = stamp_ns;
  track.largest_extent_m = std::max(track.largest_extent_m, extent_of(observation.points_m));
  remember_contour(track, observation);
}

}  // namespace

double ResponseRate::unanswered_share() const {
  constexpr double kSupposed = 0.2;  // of one beam
  return (missed + kSupposed) / (asked + 1.0);
}

ResponseRate with_responses(ResponseRate responses, std::size_t echoes, int gaps, double time_s) {
  constexpr double kMemoryS = 1.0;
  const double kept = std::exp(-time_s / kMemoryS);
  const double between = echoes > 2 ? static_cast<double>(echoes - 2) : 0.0;  // that there are two ends tells nothing
  return {kept * responses.missed + gaps, kept * responses.asked + gaps + between};
}

Observation StoredObservation::with_points() const {
  Observation seen = observation;
  seen.points_m = points_m;
  return seen;
}

void ObservationHistory::add(std::int64_t stamp_ns, const Observation& observation, const Matrix2d& pose_covariance_m2) {
  if (kept_.size() == kMost) kept_.pop_front();
  StoredObservation& kept = kept_.push_back();
  kept.stamp_ns = stamp_ns;
  kept.points_m.assign(observation.points_m.begin(), observation.points_m.end());
  kept.observation = observation;
  kept.pose_covariance_m2 = pose_covariance_m2;
}

filters::ModelSet motion_models(const TrackingConfig& config) {
  filters::ModelSet set;
  set.models[0] = {filters::MotionKind::kConstantVelocity, config.velocity_noise_density, config.idle_acceleration_mps2};
  set.models[1] = {filters::MotionKind::kConstantAcceleration, config.jerk_noise_density, 0.0};
  set.size = 2;
  set.mean_stay_s = config.mean_stay_s;
  return set;
}

bool is_vehicle(const Track& track) { return track.body.has_sides && track.body.kind != Kind::kBicycle; }

bool is_known_pedestrian(const Track& track) {
  constexpr int kLongKnownHits = 20;
  constexpr double kSure = 0.9;
  return track.confirmed && !track.body.has_sides && track.hits >= kLongKnownHits && track.class_probability[0] > kSure;
}

double gait_variance_m2(double after_s, const TrackingConfig& config) {
  const double kept = std::exp(-after_s / config.gait_memory_s);
  return config.gait_noise_m * config.gait_noise_m * (1.0 + kept) / (1.0 - kept);
}

Gait with_step(const Gait& before, const Vector2d& innovation_m, const Matrix2d& noise_m2, double time_s, const TrackingConfig& config) {
  constexpr double kMemoryS = 1.5;      // a few steps
  constexpr double kMostShare = 9.0;    // what errs by more is none who walks
  const double least_share = only_people_move(config) ? 1.0 : 0.125;  // arms swing, too; legs as is taken for them
  const double usual_m2 = config.gait_noise_m * config.gait_noise_m;
  const double was_m2 = before.variance_m2.value_or(usual_m2);
  const double seen_m2 = std::min(0.5 * (innovation_m.squaredNorm() - noise_m2.trace()), 4.0 * kMostShare * usual_m2);  // one scan does not count for all
  const double now_m2 = was_m2 + (1.0 - std::exp(-time_s / kMemoryS)) * (seen_m2 - was_m2);
  return {std::clamp(now_m2, least_share * usual_m2, kMostShare * usual_m2)};
}

HeadingNoise with_heading(const HeadingNoise& before, double off_rad, double variance_rad2, double time_s) {
  constexpr double kMemoryS = 1.5;
  constexpr double kMostShare = 4.0;
  const double seen = std::min(off_rad * off_rad / variance_rad2, kMostShare);
  return {before.share + (1.0 - std::exp(-time_s / kMemoryS)) * (seen - before.share)};
}

BeamPassage with_beams(const BeamPassage& before, int through, std::size_t met, double time_s) {
  constexpr double kMemoryS = 0.4;
  const double gain = 1.0 - std::exp(-time_s / kMemoryS);
  return {before.through + gain * (through - before.through), before.met + gain * (static_cast<double>(met) - before.met)};
}

Track initiated(flow::TrackId track_id, std::int64_t stamp_ns, const Observation& observation, double box_heading_rad,
            const Matrix2d& pose_covariance_m2, const TrackingConfig& config, const RoadUsers& road_users, Track done_with) {
  Track track = emptied(std::move(done_with));
  track.body.road_users = &road_users;
  track.track_id = track_id;
  track.first_seen_ns = stamp_ns;
  track.score = config.birth_score;
  const double extent_m = std::max(0.4, extent_of(observation.points_m));
  track.body.length = {extent_m, 1.0};
  track.body.width = {extent_m, 1.0};
  BodyMeasurement first = measure_blob(track.body, observation, config);
  if (extent_m > config.box_from_extent_m) {
    track.body = likely_box(box_heading_rad, observation, config, road_users);
    first = measure_box(track.body, supposed_centre_m(track.body, observation), observation, config);
  }
  track.body = first.body;
  filters::MotionState start;
  start.mean.head<2>() = first.centre_m;
  start.covariance.topLeftCorner<2, 2>() = first.covariance_m2 + pose_covariance_m2;
  const double speed_sigma_mps = (track.body.has_sides ? 0.5 : 0.2) * config.fastest_mps;
  start.covariance.block<2, 2>(2, 2) = speed_sigma_mps * speed_sigma_mps * Matrix2d::Identity();
  start.covariance.block<2, 2>(4, 4) = config.idle_acceleration_mps2 * config.idle_acceleration_mps2 * Matrix2d::Identity();
  track.motion = filters::imm_start(motion_models(config), start);
  track.estimate = start;
  track.birth_position_m = track.anchor_m = first.centre_m;
  track.birth_covariance_m2 = first.covariance_m2;
  observe(track, stamp_ns, observation);
  return track;
}

void predict(Track& track, double time_s, const TrackingConfig& config) {
  track.measured.reset();
  track.recentred_m.setZero();
  track.cruises_only = is_known_pedestrian(track);
  track.may_turn = config.coordinated_turn && is_known_to_go_somewhere(track, config);
  const filters::ModelSet models = models_of(track, config);
  track.motion = filters::imm_predict(models, track.motion, time_s);
  track.estimate = filters::imm_combine(models, track.motion);
  track.body.heading_variance_rad2 = std::min(10.0, track.body.heading_variance_rad2 + heading_drift_rad2_per_s(config) * time_s);
  track.body.axis_variance_rad2 = std::min(10.0, track.body.axis_variance_rad2 + heading_drift_rad2_per_s(config) * time_s);
}

bool update(Track& track, std::int64_t stamp_ns, const Observation& observation, const Matrix2d& pose_covariance_m2, const TrackingConfig& config) {
  const filters::ModelSet models = models_of(track, config);
  constexpr double kLeastStepS = 1e-3;  // of two scanners at the same stamp
  const double unseen_s = std::max(kLeastStepS, static_cast<double>(stamp_ns - track.last_seen_ns) * 1e-9);
  if (track.body.has_sides) lie_along_what_is_seen(track, observation, config);
  if (track.body.has_sides) follow_side(track, observation, unseen_s, config);  // first: sizes are measured along the sides
  const BodyMeasurement measurement = measure(track.body, track.position_m(), observation, config);
  Matrix2d R = measurement.covariance_m2 + pose_covariance_m2;
  const Matrix2d noise_at_rest_m2 = R;
  if (may_be_pedestrian(track)) R += gait_variance_m2(unseen_s, config) * Matrix2d::Identity();
  const Vector2d innovation_m = measurement.centre_m - measurement.recentring_m - track.position_m();
  const double distance2 = association::mahalanobis_squared<2>(innovation_m, track.position_covariance_m2() + measurement.step_covariance_m2 + R);
  if (track.confirmed && distance2 > config.most_surprise_sigmas * config.most_surprise_sigmas && innovation_m.norm() > config.least_surprise_m) return false;
  track.innovation_m = innovation_m.norm();
  if (may_be_pedestrian(track)) {
    const Gait before{std::pow(swing_share(track, config) * config.gait_noise_m, 2)};
    track.gait = with_step(before, innovation_m, noise_at_rest_m2, unseen_s, config);
  }
  shift(track, measurement.recentring_m, models);
  filters::imm_loosen(models, track.motion, measurement.step_covariance_m2);
  track.body = measurement.body;
  const Matrix2d R_of_theirs = track.cruises_only ? Matrix2d(times_noise(distance2) * R) : R;
  track.motion = filters::imm_update(models, track.motion, measurement.centre_m, R_of_theirs).posterior;
  track.measured = {measurement.centre_m, R_of_theirs};
  track.estimate = filters::imm_combine(models, track.motion);
  filters::MotionState moving = track.estimate;
  moving.covariance *= noise_at_rest_m2.trace() / R.trace();  // legs that stand do not swing
  track.move_stop = filters::weigh(track.move_stop, {moving, measurement.centre_m, unseen_s}, move_stop_config(config));
  observe(track, stamp_ns, observation);
  // What is hidden goes on unseen: only when it is seen again, its claim can be judged.
  track.claimed_travel_m += std::max(0.0, track.velocity_mps().norm() - config.moving_above_mps) * unseen_s;
  if (track.body.has_sides) steer(track, unseen_s, config);
  if (track.body.has_sides) follow_course(track, observation, unseen_s, config);
  else draw_sides_when_known(track, observation, config);
  const double off_sides_m = distance_from_sides_m(track, observation.points_m);
  track.range_m = (track.position_m() - observation.laser_m).norm();
  track.consistency = with_scan(track.consistency, off_sides_m, distance2, unseen_s);
  if (track.confirmed && track.body.has_sides) track.outline_error = with_scan(track.outline_error, off_sides_m, observation.points_m.size(), track.range_m, config);
  update_motion_state(track, config);
  if (track.velocity_mps().norm() > config.moving_above_mps || track.state == flow::Motion::kMoving) track.last_moving_ns = stamp_ns;
  update_class(track, unseen_s, config);
  return true;
}

void confirm(Track& track, std::int64_t stamp_ns, const TrackingConfig& config) {
  track.confirmed = true;
  track.last_moving_ns = stamp_ns;  // though it may be as slow as what stops
  track.travelled_m = 0.0;  // until now it may have been made of several things
  track.anchor_m = track.position_m();
  track.past.clear();
  track.observations.clear();
  if (has_known_speed(track, config)) track.speeds = with_first_speed({track.velocity_mps().norm(), speed_sigma_mps(track)}, config);
  update_class(track, 0.0, config);
}

void reinitialise_extent(Track& track, const Observation& observation, const TrackingConfig& config) {
  const Body body = box_along_course(track, observation, config);
  const BodyMeasurement drawn = measure_box(body, supposed_centre_m(body, observation), observation, config);
  const filters::ModelSet models = models_of(track, config);
  track.body = drawn.body;
  shift(track, drawn.centre_m - track.position_m(), models);
  track.estimate = filters::imm_combine(models, track.motion);
  track.largest_extent_m = std::max(track.largest_extent_m, extent_of(observation.points_m));
}

void reinitialise_extent_if_misfit(Track& track, const Observation& observation, double time_s, const TrackingConfig& config) {
  constexpr double kAfterS = 0.15;
  constexpr std::size_t kFewestEchoes = 5;
  track.misfit_s = misfits_only(track, config) ? track.misfit_s + time_s : 0.0;
  if (track.misfit_s <= kAfterS || observation.points_m.size() < kFewestEchoes) return;
  reinitialise_extent(track, observation, config);
  track.misfit_s = 0.0;
}

void restart_motion(Track& track, const Vector2d& velocity_mps, double sigma_mps, const TrackingConfig& config) {
  filters::MotionState start;
  start.mean.head<2>() = track.position_m();
  start.mean.segment<2>(2) = velocity_mps;
  start.covariance.topLeftCorner<2, 2>() = track.position_covariance_m2();
  start.covariance.block<2, 2>(2, 2) = sigma_mps * sigma_mps * Matrix2d::Identity();
  start.covariance.block<2, 2>(4, 4) = config.idle_acceleration_mps2 * config.idle_acceleration_mps2 * Matrix2d::Identity();
  move_as(track, start, config);
}

void move_as(Track& track, const filters::MotionState& state, const TrackingConfig& config) {
  track.motion = filters::imm_start(motion_models(config), state);
  track.may_turn = false;
  track.cruises_only = false;
  track.estimate = state;
}

void score_hit(Track& track, flow::PointLabel label, const MotionEvidence& evidence, double time_s, const TrackingConfig& config) {
  const bool is_moving = label == flow::PointLabel::kMoving || evidence.moved > evidence.stood + 0.5 * evidence.undecided;
  track.moving_hits += is_moving ? 1 : 0;
  const double fade = std::exp(-time_s / config.evidence_memory_s);
  track.evidence.moved = fade * track.evidence.moved + evidence.moved;
  track.evidence.stood = fade * track.evidence.stood + evidence.stood;
  track.evidence.undecided = fade * track.evidence.undecided + evidence.undecided;
  double gain = is_moving ? config.moving_hit_score : config.other_hit_score;
  const bool is_mapped = label == flow::PointLabel::kStationary && !is_moving;
  track.mapped_share += (1.0 - std::exp(-time_s / config.mapped_memory_s)) * ((is_mapped ? 1.0 : 0.0) - track.mapped_share);
  track.without_progress_s += time_s;
  const bool is_slow = track.velocity_mps().norm() < config.moving_above_mps || track.without_progress_s > config.longest_stand_s;
  if (track.mapped_share > config.most_mapped_share && is_slow) gain = config.mapped_score_per_s * time_s;
  const double stands_share = evidence.stood / std::max(1.0, evidence.stood + evidence.moved + evidence.undecided);
  // Who walks comes to where nothing was; what always may have been where it is only seems to walk, from thing to thing.
  const bool seems_to_walk = track.confirmed && may_be_pedestrian(track) && !is_moving && evidence.moved == 0.0;
  if ((stands_share > 0.5 || seems_to_walk) && track.velocity_mps().norm() > config.contradicted_above_mps) gain = config.contradiction_score;
  if (!is_plausible(track.body, config) || track.velocity_mps().norm() > 2.0 * config.fastest_mps) gain = config.implausible_score;
  constexpr double kNoSuchBodyScore = -0.3;  // a vehicle drawn wrong is drawn anew before it is given up
  if (is_inconsistent(track, config)) gain = std::min(gain, kNoSuchBodyScore);
  track.score = std::min(config.most_score, track.score + gain);
}

void score_miss(Track& track, const Visibility& visibility, double time_s, const TrackingConfig& config) {
  track.score += (visibility.beams == 0 ? config.out_of_view_score_per_s : config.occluded_score_per_s) * time_s;
  // What hides the body before and behind counts less: a share of the beams decides how sure the miss is.
  constexpr double kLegUnanswered = 0.1;  // legs are thin and often dark; a vehicle answers
  const double passed = visibility.passed + (only_people_move(config) && may_be_pedestrian(track) ? kLegUnanswered : 1.0) * visibility.unanswered;
  const double share = visibility.beams == 0 ? 0.0 : passed / visibility.beams;
  track.score += std::max(config.most_passed_score, config.passed_beam_score * passed) * share;
}

bool appeared_in_free_space(const Track& track, const TrackingConfig& config) {
  constexpr double kFewestEchoes = 3.0;          // of fewer each may be a mixed pixel of something else
  constexpr double kLeastShareInFreeSpace = 0.7; // the map is not sure of all that it has seen through
  constexpr double kMostStoodShare = 0.2;        // a flank lies where it was, and echoes of others are near
  const TentativeEvidence& observations = track.tentative_evidence;
  const MotionEvidence& now = track.evidence;
  return !only_people_move(config) && track.echoes >= kFewestEchoes && observations.in_free_space >= kLeastShareInFreeSpace * observations.seen &&
         observations.stood <= kMostStoodShare * observations.seen && now.stood <= kMostStoodShare * weight_of(now);
}

Body inner_part_of(const Track& track) {
  constexpr double kLeastM = 0.3;
  const double sigma_m = std::sqrt(0.5 * track.position_covariance_m2().trace());
  Body inner = track.body;
  for (Size* size : {&inner.length, &inner.width}) size->value_m = std::max(kLeastM, size->value_m - std::sqrt(size->variance_m2) - 2.0 * sigma_m);
  return inner;
}

void score_passed(Track& track, const Visibility& inner_part, std::size_t echoes, const TrackingConfig& config) {
  constexpr double kLeastMappedShare = 0.05;
  const int excess = inner_part.passed - static_cast<int>(echoes);
  if (excess <= 0 || track.mapped_share < kLeastMappedShare) return;
  track.score += std::max(config.most_passed_score, config.passed_beam_score * excess) * inner_part.passed / inner_part.beams;
}

bool is_confirmable(const Track& track, const TrackingConfig& config) { return !echoes_lie_off_sides(track, config) && moves_by_all_signs(track, config); }

bool misfits_only(const Track& track, const TrackingConfig& config) { return echoes_lie_off_sides(track, config) && moves_by_all_signs(track, config); }

const Track* inconsistent_one(const Track& a, const Track& b, const TrackingConfig& config) {
  if (!a.body.has_sides || !b.body.has_sides || is_inconsistent(a, config) == is_inconsistent(b, config)) return nullptr;
  return is_inconsistent(a, config) ? &a : &b;
}

bool has_published_velocity(const Track& track, const TrackingConfig& config) {
  return speed_sigma_mps(track) <= config.most_speed_sigma_published_mps;
}

bool is_timed_out(const Track& track, double age_s, const TrackingConfig& config) {
  constexpr double kTimesIfMoving = 2.0;
  if (track.confirmed || age_s <= config.longest_tentative_s) return false;
  const bool seems_to_move = track.score >= config.confirm_score && is_surely_fast(track, config) && has_travelled(track, config);
  return !seems_to_move || age_s > kTimesIfMoving * config.longest_tentative_s;
}

bool claims_motion_without_travel(const Track& track, const TrackingConfig& config) {
  constexpr double kMostTimesProgress = 4.0;
  return track.claimed_travel_m > kMostTimesProgress * kProgressM * config.size_scale;
}

bool has_stood_too_long(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config) {
  const double least_share = only_people_move(config) ? 1.0 : 0.25;  // what has come next to no way is soon held never to have moved
  const double may_stand_s = config.longest_stand_s * std::max(least_share, track.travelled_m / config.least_travel_to_stand_m);
  const bool is_vehicle_that_came = !only_people_move(config) && track.body.has_sides && track.travelled_m >= config.least_travel_to_stand_m;
  const std::int64_t idle_since_ns = is_vehicle_that_came ? std::max(track.last_moving_ns, track.last_seen_ns) : track.last_moving_ns;
  return static_cast<double>(stamp_ns - idle_since_ns) * 1e-9 > may_stand_s;
}

flow::TrackedObject published(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config, flow::TrackedObject done_with) {
  flow::TrackedObject object = std::move(done_with);
  object.track_id = track.track_id;
  // Between two scans of the scanner that has it in view it is not unseen, at up to so few a second.
  constexpr double kLongestBetweenLooksS = 0.25;
  const double since_in_view_s = std::min(track.since_in_view_s, kLongestBetweenLooksS);
  const double unseen_s = static_cast<double>(stamp_ns - track.last_seen_ns) * 1e-9 - since_in_view_s;
  // What has got nowhere yet and seems to stand already may never have moved; it is followed until that is known. Where only
  // people move it is the foot on which somebody stands while the other swings.
  const bool may_always_have_stood = !only_people_move(config) && track.travelled_m == 0.0 && (track.move_stop.stands || track.velocity_mps().norm() < config.stopped_below_mps);
  object.confirmed = track.confirmed && !track.is_refuted && !may_always_have_stood && track.score >= config.publish_score &&
                     has_published_velocity(track, config) && !is_doubted(track) &&
                     unseen_s <= config.longest_unseen_published_s;
  object.existence = existence_of(track.score);
  const filters::MotionState estimate = filters::estimate_of(track.move_stop, track.estimate);
  object.velocity_in_odom_mps = estimate.mean.segment<2>(2);
  const Vector2d since_stamp_m = track.time_offset_s * object.velocity_in_odom_mps;
  object.position_in_odom_m = track.position_m() - since_stamp_m;
  const Eigen::DiagonalMatrix<double, 4> share = with_own_errors(track, config);
  object.covariance = share * covariance_after(track.estimate.covariance.topLeftCorner<4, 4>(), -track.time_offset_s) * share;
  object.acceleration_in_odom_mps2 = estimate.mean.segment<2>(4);
  object.heading_in_odom_rad = track.body.has_sides ? track.body.heading_rad : course_of(track).heading_rad;
  object.length_m = track.body.length.value_m;
  object.width_m = track.body.width.value_m;
  object.motion = track.move_stop.stands ? flow::Motion::kStopped : track.state;
  object.object_class = track.object_class;
  object.class_probability = track.class_probability;
  object.mode_probability = track.motion.probability;
  object.first_seen_ns = track.first_seen_ns;
  object.last_seen_ns = track.last_seen_ns;
  object.contour_in_odom_m = track.contour_in_odom_m;
  for (Eigen::Vector2f& point_m : object.contour_in_odom_m) point_m -= since_stamp_m.cast<float>();
  const Matrix2d shared_error_m2 = shared_error_covariance(track, object.heading_in_odom_rad, config);
  object.covariance.topLeftCorner<2, 2>() += shared_error_m2;
  object.predicted_path.clear();
  if (track.confirmed) predict_path(track, shared_error_m2, config, object.predicted_path);
  for (flow::PredictedPosition& there : object.predicted_path) there.position_in_odom_m -= since_stamp_m;
  return object;
}

Track track_from_message(const flow::TrackedObject& object, const TrackingConfig& config) {
  Track track;
  track.track_id = object.track_id;
  track.confirmed = object.confirmed;
  track.score = std::log(std::max(object.existence, 1e-6) / std::max(1.0 - object.existence, 1e-6));
  track.score = std::min(track.score, config.most_score);
  track.state = object.motion;
  track.object_class = object.object_class;
  track.class_probability = object.class_probability;
  track.first_seen_ns = object.first_seen_ns;
  track.last_seen_ns = object.last_seen_ns;
  track.last_moving_ns = object.last_seen_ns;
  track.travelled_m = config.least_travel_to_stand_m;
  track.hits = config.least_hits;
  track.largest_extent_m = object.length_m;
  track.body.has_sides = object.length_m > config.box_from_extent_m;
  track.body.heading_rad = object.heading_in_odom_rad;
  track.body.heading_variance_rad2 = 0.05;
  track.body.length = {object.length_m, 0.3};
  track.body.width = {object.width_m, 0.05};
  if (track.body.has_sides) {
    track.body.is_oriented = true;
    track.body.length_evidence.whole = {object.length_m, 0.3};
    track.body.width_evidence.whole = {object.width_m, 0.05};
    track.body = with_likely_sizes(track.body, config);
  }
  filters::MotionState start;
  start.mean << object.position_in_odom_m, object.velocity_in_odom_mps, object.acceleration_in_odom_mps2;
  start.covariance.topLeftCorner<4, 4>() = object.covariance;
  start.covariance.block<2, 2>(4, 4) = config.idle_acceleration_mps2 * config.idle_acceleration_mps2 * Matrix2d::Identity();
  track.motion = filters::imm_start(motion_models(config), start);
  track.estimate = start;
  track.birth_position_m = track.anchor_m = object.position_in_odom_m;
  return track;
}

void learn_sizes(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config) {
  constexpr double kKnownM = 0.15;     // one sigma
  const Body& body = track.body;
  const double scale = config.size_scale;
  if (!track.confirmed || !body.has_sides || !body.is_oriented || track.travelled_m < kLeastWayM * scale) return;
  const double known_m2 = std::pow(kKnownM * scale, 2);
  const auto of_real_one = [&](const Size& size) { return Size{size.value_m / scale, size.variance_m2 / (scale * scale)}; };
  const EvidenceOfSizes evidence = evidence_by_kind(body, config).of(body.kind);
  const Size length = evidence.length.whole;
  const Size width = evidence.width.whole;
  // Seen from edge to edge it lacks what sent no echoes there; the most that was ever seen of it holds the farthest that any erred.
  const auto between = [](const Size& whole, double least_m) {
    const double off_m = 0.5 * std::max(0.0, least_m - whole.value_m);
    return Size{whole.value_m + off_m, whole.variance_m2 + off_m * off_m};
  };
  if (length.variance_m2 > known_m2 || body.length.variance_m2 > known_m2) return;  // the length tells the kind
  seen.add_length(body.kind, of_real_one(between(length, body.length_evidence.least_m)));
  if (width.variance_m2 <= known_m2 && body.width.variance_m2 <= known_m2) seen.add_width(body.kind, of_real_one(between(width, body.width_evidence.least_m)));
  if (body.kind != Kind::kBicycle && body.corner_seen.variance_m2 <= known_m2) seen.add_corner(of_real_one(body.corner_seen));
}

void learn_outline_error(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config) {
  constexpr int kFewestScans = 20;
  const bool is_known_vehicle = track.confirmed && is_vehicle(track) && track.body.is_oriented;
  if (!is_known_vehicle || only_people_move(config) || track.travelled_m < kLeastWayM * config.size_scale || track.outline_error.scans < kFewestScans) return;
  seen.add_off_sides_share(track.outline_error.shares / track.outline_error.echoes);
}

void learn_gait(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config) {
  constexpr double kSeenForS = 3.0;  // twice the memory for it
  const double seen_for_s = static_cast<double>(track.last_seen_ns - track.first_seen_ns) * 1e-9;
  if (!track.confirmed || !may_be_pedestrian(track) || only_people_move(config) || !track.gait.variance_m2 || seen_for_s < kSeenForS) return;
  seen.add_swing_share(swing_share(track, config));
}

double existence_of(double score) { return 1.0 / (1.0 + std::exp(-score)); }

}  // namespace slammot::tracking
