#include "common/matching/log_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "common/matching/odometry_point.hpp"
#include "common/matching/pair_matching.hpp"
#include "common/matching/pair_registration.hpp"
#include "common/matching/pair_statistics.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/matching/wall_bend.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::wrap_angle;
using std::numbers::pi;

constexpr double kConsistent = 0.75;     // least length of a mean direction vector
constexpr double kTurnedSeen_rad = 0.4;  // of a scanner: by single pairs; less needs all of them
constexpr double kOtherSize = 0.15;      // of turns; less is learned during the drive
constexpr double kMostly = 0.8;          // of the turns by odometry, to the side of those by scans;
                                         // of fewer it is noise that scans say next to nothing of

/// The pair's motion as its points say that are nearest to the surfaces of the first scan: better
/// than a cell of the search.
Pose2 registered(PointToLineMatcher& matcher, const ScanPair& pair, const AssumedBeams& beams,
                 double unit_m, const Pose2& by_scans) {
  constexpr double kSigma_m = 0.1;
  constexpr double kSigma_rad = 0.02;
  const geometry::UncertainPose2 prior{
      by_scans, Eigen::Vector3d(kSigma_m, kSigma_m, kSigma_rad).cwiseAbs2().asDiagonal()};
  return register_pair(matcher, pair, beams, unit_m, prior).map_from_base.pose;
}

std::optional<OdometryPoint> odometry_point(std::span<const ScanPair> pairs,
                                            const AssumedBeams& beams, double unit_m,
                                            const std::vector<MatchedPair>& matched) {
  PointToLineMatcher matcher;
  std::vector<PairMotion> motions;
  for (const MatchedPair& pair : matched)
    motions.push_back(
        {pair.by_odometry, registered(matcher, pairs[pair.number], beams, unit_m, pair.by_scans)});
  return odometry_point(motions);
}

/// Assumes a scanner mounted straight, backwards or at right angles, unless the evidence clearly
/// differs.
double at_right_angle(double turn_rad) {
  constexpr double kNearlyRad = 0.3;
  const double right_rad = std::round(turn_rad / (0.5 * pi)) * 0.5 * pi;
  return std::abs(turn_rad - right_rad) < kNearlyRad ? right_rad : turn_rad;
}

AssumedBeams with_field(const AssumedBeams& beams, double factor) {
  AssumedBeams wider = beams;
  wider.first_beam_rad *= factor;
  wider.beam_step_rad *= factor;
  return wider;
}

/// First scans of the pairs, in metres.
std::vector<std::vector<float>> first_scans_m(std::span<const ScanPair> pairs, double unit_m) {
  std::vector<std::vector<float>> scans_m;
  for (const ScanPair& pair : pairs) {
    scans_m.push_back(pair.first);
    for (float& range : scans_m.back()) range *= static_cast<float>(unit_m);
  }
  return scans_m;
}

/// How much walls bend with this layout; none if few walls are seen.
std::optional<WallBend> bend_with(std::span<const std::vector<float>> scans_m,
                                  const AssumedBeams& beams) {
  constexpr std::size_t kFewestWalls = 20;
  const WallBend found = wall_bend(scans_m, beams.first_beam_rad, beams.beam_step_rad);
  return found.windows < kFewestWalls ? std::nullopt : std::optional(found);
}

/// Fields of view of existing scanners.
constexpr std::array kUsualFields_deg{90.0, 100.0, 120.0, 180.0, 190.0, 240.0, 270.0, 360.0};

/// Whether so many beams may lie in this field of view. Those of 100 and 190 degrees lie near
/// another one, and belong to scanners whose beams are a whole share of a degree apart.
bool may_span(double degrees, std::size_t beams) {
  if (degrees != 100.0 && degrees != 190.0) return true;
  const double beams_per_degree = static_cast<double>(beams - 1) / degrees;
  return beams_per_degree >= 1.0 && beams_per_degree == std::round(beams_per_degree);
}

/// A wrong field of view scales the turns by scans, and bends walls. The turns raise the question,
/// and walls answer it: odometry's turns may err, too, and two scans that differ by a rotation
/// match with any field of view. Where walls are straight as stated, or too few to tell, the stated
/// field is kept. An accepted factor must give a field of view of existing scanners.
double field_factor(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                    const LogCorrection& correction, const std::vector<MatchedPair>& as_stated) {
  constexpr double kTurnsAgree = 0.87;
  constexpr double kStraighter = 0.5;
  constexpr double kBent_sigmas = 5.0;  // straight walls of seven logs: up to 1.7
  constexpr double kSameField = 0.02;   // 361 beams of half a degree are 180 degrees
  const double scale = std::abs(turn_scale(turning(as_stated)));
  if (pairs.empty() || !(scale > 0.0) || (scale > kTurnsAgree && scale < 1.0 / kTurnsAgree))
    return 1.0;
  const double stated_rad =
      std::abs(beams.beam_step_rad) * static_cast<double>(pairs.front().first.size());
  double best = 1.0;
  const auto scans_m = first_scans_m(pairs, correction.range_unit_m);
  const std::optional<WallBend> stated = bend_with(scans_m, beams);
  if (!stated || std::abs(stated->bend) < kBent_sigmas * stated->sigma) return 1.0;
  double least_bend = kStraighter * std::abs(stated->bend);
  for (const double degrees : kUsualFields_deg) {
    const double factor = degrees / 180.0 * pi / stated_rad;
    if (std::abs(factor - 1.0) < kSameField || !may_span(degrees, pairs.front().first.size()))
      continue;
    const std::optional<WallBend> found = bend_with(scans_m, with_field(beams, factor));
    if (!found || std::abs(found->bend) >= least_bend) continue;
    best = factor;
    least_bend = std::abs(found->bend);
  }
  return best;
}

/// Decides which is mirrored: odometry's headings, its positions, or the beams. Clockwise beams
/// look like odometry that is mirrored as a whole. Correct odometry moves on the arcs of its turns;
/// odometry integrated with the wrong turn sign moves against them. Only correct odometry implies
/// mirrored beams. Without evidence of either, the recorded beam order is kept.
void correct_signs(const OdometryCheck& odometry, double same_sign, double way_unit_m,
                   LogEvidence& evidence) {
  LogCorrection& correction = evidence.correction;
  const bool turns_agree = same_sign > kMostly;
  const bool turns_differ = same_sign < 1.0 - kMostly;
  if (odometry.positions_are_mirrored()) {
    // direction + heading is constant: either positions or headings are mirrored, and rotated by
    // that angle.
    correction.mirrors_position = turns_agree;
    correction.mirrors_heading = turns_differ;
    if (turns_agree) correction.position_turn_rad = odometry.mirrored_direction_rad();
    if (turns_differ) correction.position_turn_rad = -odometry.mirrored_direction_rad();
    return;
  }
  if (!turns_differ) return;
  correction.reverses_beams = odometry.turns_with_its_arcs(way_unit_m);
  correction.mirrors_position = correction.mirrors_heading = !correction.reverses_beams;
  correction.integrates_turns_anew = odometry.turns_against_its_arcs(way_unit_m);
  evidence.handedness_is_told = correction.reverses_beams || correction.integrates_turns_anew;
}

/// Power of ten that makes the scale one; 1 if the scale is no power of ten.
double unit_by_scale(double scale) {
  for (const double unit : {1e-3, 1e-2}) {
    if (scale > 0.6 * unit && scale < 1.7 * unit) return unit;
  }
  return 1.0;
}

void reverse(ScanPair& pair) {
  std::reverse(pair.first.begin(), pair.first.end());
  std::reverse(pair.second.begin(), pair.second.end());
}

/// A scanner that looks elsewhere than it is said to; where odometry is mirrored, its positions are
/// turned instead.
void correct_mounting(const std::vector<MatchedPair>& straight_pairs, const AssumedBeams& beams,
                      LogCorrection& correction) {
  const std::complex<double> mounted =
      mounting(straight_pairs) * std::polar(1.0, -beams.laser_heading_rad);
  const double turn_rad = std::arg(mounted);
  if (straight_pairs.size() < kFewestPairs || !(std::abs(mounted) > kConsistent) ||
      !(std::abs(turn_rad) > kTurnedSeen_rad))
    return;
  if (correction.mirrors_position != correction.mirrors_heading) {
    correction.position_turn_rad =
        wrap_angle(correction.position_turn_rad - at_right_angle(turn_rad));
  } else {
    correction.laser_turn_rad = at_right_angle(turn_rad);
  }
}

/// A scanner that seems to look backwards, and to be as far behind the vehicle's middle as it is
/// said to be ahead: its pose is as said, and the way by odometry has the wrong sign.
bool way_has_the_wrong_sign(const OdometryPoint& point, const AssumedBeams& beams,
                            const LogCorrection& correction) {
  constexpr double kSigmas = 4.0;
  constexpr double kRightTurn_rad = 0.01;
  const geometry::Vector2& said_m = beams.laser_in_base_m;
  const geometry::Vector2 found_m = point.odometry_from_laser.translation_m();
  const double sigma_m = std::hypot(point.sigma.x_m, point.sigma.y_m);
  return std::abs(std::abs(correction.laser_turn_rad) - pi) < kRightTurn_rad &&
         !correction.mirrors_position && !correction.mirrors_heading &&
         (found_m - said_m).norm() > (found_m + said_m).norm() + kSigmas * sigma_m;
}

void correct_sign_of_way(const AssumedBeams& beams, OdometryPoint& point,
                         LogCorrection& correction) {
  if (!way_has_the_wrong_sign(point, beams, correction)) return;
  correction.laser_turn_rad = 0.0;
  correction.position_turn_rad = wrap_angle(correction.position_turn_rad + pi);
  point.odometry_from_laser = Pose2{0.0, 0.0, pi} * point.odometry_from_laser;
}

/// A scanner turned a little, and odometry of another point of the vehicle: each where the pairs
/// determine it well enough to tell it from none.
void place_odometry(const OdometryPoint& point, const AssumedBeams& beams,
                    LogCorrection& correction) {
  constexpr double kTurned_rad = 0.02;
  constexpr double kApart_m = 0.2;
  constexpr double kSigmas = 4.0;
  constexpr double kMostSigma_rad = 0.02;  // more, and pairs were matched wrongly
  constexpr double kMostSigma_m = 0.3;
  if (point.sigma.heading_rad > kMostSigma_rad) return;
  const Pose2& found = point.odometry_from_laser;
  const double turned_rad = wrap_angle(found.heading_rad - beams.laser_heading_rad);
  if (correction.laser_turn_rad == 0.0 && std::abs(turned_rad) < kTurnedSeen_rad &&
      std::abs(turned_rad) > std::max(kTurned_rad, kSigmas * point.sigma.heading_rad))
    correction.laser_turn_rad = turned_rad;
  const geometry::Vector2 apart_m = found.translation_m() - beams.laser_in_base_m;
  const double sigma_m = std::hypot(point.sigma.x_m, point.sigma.y_m);
  if (sigma_m < kMostSigma_m && apart_m.norm() > std::max(kApart_m, kSigmas * sigma_m))
    correction.odometry_from_base = {apart_m.x(), apart_m.y(), 0.0};
}

LogEvidence weigh_in_unit(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                          const OdometryCheck& odometry, double range_unit_m) {
  LogEvidence evidence;
  LogCorrection& correction = evidence.correction;
  correction.range_unit_m = range_unit_m;
  if (odometry.is_in_degrees()) correction.heading_unit_rad = pi / 180.0;
  std::vector<MatchedPair> matched = match_all(pairs, beams, correction);
  evidence.pairs = matched.size();
  const std::size_t tried = pairs_within_reach(pairs, correction);
  evidence.matched_share =
      tried == 0 ? 0.0 : static_cast<double>(matched.size()) / static_cast<double>(tried);
  const std::vector<MatchedPair> turning_pairs = turning(matched);
  evidence.turning_pairs = turning_pairs.size();
  evidence.turn_sign_share = same_sign_share(turning_pairs);
  if (matched.size() < kFewestPairs) return evidence;
  if (turning_pairs.size() >= kFewestPairs) {
    correct_signs(odometry, evidence.turn_sign_share, unit_by_scale(way_scale(straight(matched))),
                  evidence);
    correction.field_factor = field_factor(pairs, beams, correction, matched);
  }
  // A second pass if the beam layout changed, or a unit and with it the points within range.
  std::vector<ScanPair> looked_at(pairs.begin(), pairs.end());
  if (correction.reverses_beams) std::for_each(looked_at.begin(), looked_at.end(), reverse);
  if (correction.reverses_beams || correction.field_factor != 1.0)
    matched = match_all(looked_at, with_field(beams, correction.field_factor), correction);
  const double scale = way_scale(straight(matched));
  correction.way_unit_m = unit_by_scale(scale);
  if (correction != LogCorrection{})
    matched = match_all(looked_at, with_field(beams, correction.field_factor), correction);
  const std::vector<MatchedPair> straight_pairs = straight(matched);
  correct_mounting(straight_pairs, beams, correction);
  take_odometry_anew(looked_at, correction, matched);
  for (const MatchedPair& pair : matched)
    evidence.motions.push_back({pair.first_scan, pair.second_scan, pair.by_scans.heading_rad,
                                pair.by_scans.translation_m().norm()});
  // Mirrored turns are integrated anew from step to step; two poses far apart hold another motion.
  auto point = correction.integrates_turns_anew
                   ? std::nullopt
                   : odometry_point(looked_at, with_field(beams, correction.field_factor),
                                    correction.range_unit_m, matched);
  if (point) {
    correct_sign_of_way(beams, *point, correction);
    place_odometry(*point, beams, correction);
  }
  evidence.way_scale = way_scale(straight_pairs);
  evidence.turn_scale = turn_scale_of_both(matched);
  if (evidence.turn_scale > 0.0 && std::abs(evidence.turn_scale - 1.0) > kOtherSize) {
    if (same_sign_share(turning(matched)) > kMostly) correction.turn_factor = evidence.turn_scale;
    else evidence.turn_scale = 0.0;
  }
  return evidence;
}

}  // namespace

LogEvidence weigh_log(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                      const OdometryCheck& odometry, double range_unit_m) {
  LogEvidence evidence = weigh_in_unit(pairs, beams, odometry, range_unit_m);
  if (range_unit_m == 1.0) return evidence;
  const auto fits = [](const LogEvidence& one) {
    return one.correction.way_unit_m == 1.0 && one.way_scale > 0.5 && one.way_scale < 2.0;
  };
  if (fits(evidence)) return evidence;
  const LogEvidence other =
      weigh_in_unit(pairs, beams, odometry, range_unit_m == 1e-3 ? 1e-2 : 1e-3);
  return fits(other) ? other : evidence;
}

double range_unit_of(double median_reading, double far_reading) {
  constexpr double kNoScannersMedian = 100.0;
  constexpr double kLeastFarMillimetres = 2500.0;
  if (median_reading < kNoScannersMedian) return 1.0;
  return far_reading > kLeastFarMillimetres ? 1e-3 : 1e-2;
}

}  // namespace slammot::matching
