#include "common/matching/log_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "common/geometry/order_statistics.hpp"
#include "common/matching/correlative.hpp"
#include "common/matching/odometry_point.hpp"
#include "common/matching/pair_registration.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/matching/wall_bend.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::wrap_angle;
using std::numbers::pi;

constexpr double kConsistent = 0.75;  // least length of a mean direction vector
constexpr double kClearly = 0.35;     // margin by which one explanation must beat another
constexpr std::size_t kFewestPairs = 8;
constexpr double kTurningRad = 0.045;
constexpr double kStraightRad = 0.12;
constexpr double kMovingM = 0.15;
constexpr double kArcsSeen = 0.1;
constexpr double kEitherWay = -0.5;

/// A pair of scans with its motion by odometry and by scans.
struct MatchedPair {
  Pose2 by_odometry;  // of base, with the corrections so far
  Pose2 by_scans;     // of the laser
  double score = 0.0;
  std::size_t first_scan = 0;
  std::size_t second_scan = 0;
  std::size_t number = 0;  // among the pairs
};

Pose2 motion_by_odometry(const ScanPair& pair, const LogCorrection& correction) {
  return inverse(corrected(correction, pair.first_recorded)) *
         corrected(correction, pair.second_recorded);
}

/// Sub-cell position of the peak: vertex of the parabola through the scores around it, along each
/// axis.
Pose2 refined(const CorrelativeMatcher& matcher, std::span<const Eigen::Vector2f> source,
              const Pose2& peak) {
  constexpr double kStepM = 0.1;
  constexpr double kStepRad = 0.01;
  const double middle = matcher.score(source, peak);
  const auto top = [&](const Pose2& before, const Pose2& after) {
    const double lower = matcher.score(source, before);
    const double upper = matcher.score(source, after);
    const double bend = lower - 2.0 * middle + upper;
    return bend < 0.0 ? std::clamp(0.5 * (lower - upper) / bend, -0.5, 0.5) : 0.0;
  };
  const auto& [x_m, y_m, heading_rad] = peak;
  return {x_m + kStepM * top({x_m - kStepM, y_m, heading_rad}, {x_m + kStepM, y_m, heading_rad}),
          y_m + kStepM * top({x_m, y_m - kStepM, heading_rad}, {x_m, y_m + kStepM, heading_rad}),
          heading_rad + kStepRad * top({x_m, y_m, heading_rad - kStepRad},
                                       {x_m, y_m, heading_rad + kStepRad})};
}

constexpr double kReachM = 1.6;

/// False for a pair that odometry has farther apart than the search reaches, by a factor that is no
/// unit: where such a pair matches, it matches in a wrong place, and tells of no scale or sign.
bool is_within_reach(const Pose2& by_odometry) {
  constexpr double kMostFactor = 1.5;
  constexpr double kAnotherUnit_m = 20.0;
  const double way_m = by_odometry.translation_m().norm();
  return way_m < kMostFactor * kReachM || way_m > kAnotherUnit_m;
}

struct PairPeak {
  Pose2 target_from_source;
  double score = 0.0;
};

/// Search window for any turn up to 1.5 rad of either sign, and for the way in any direction.
std::optional<PairPeak> best_match(CorrelativeMatcher& matcher, const std::vector<float>& target,
                                   const std::vector<float>& source, const AssumedBeams& beams,
                                   const LogCorrection& correction, double turn_rad) {
  constexpr std::size_t kTargetPoints = 360;
  constexpr std::size_t kSourcePoints = 90;
  constexpr std::size_t kFewestPoints = 20;
  const auto target_m = points_of(target, beams, correction.range_unit_m, kTargetPoints);
  const auto source_m = points_of(source, beams, correction.range_unit_m, kSourcePoints);
  if (target_m.size() < kFewestPoints || source_m.size() < kFewestPoints) return std::nullopt;
  std::vector<TargetPoint> stamped;
  float reach_m = 5.0F;
  for (const Eigen::Vector2f& point : target_m) {
    stamped.push_back({point.x(), point.y(), 1.0F});
    reach_m = std::max({reach_m, std::abs(point.x()), std::abs(point.y())});
  }
  const double half_m = static_cast<double>(reach_m) + 0.5;
  matcher.set_target(stamped,
                     {.half_width_m = half_m, .half_height_m = half_m, .largest_shift_m = kReachM});
  const auto peaks = matcher.search(source_m, Pose2::identity(),
                                    {kReachM, kReachM, std::clamp(2.3 * turn_rad, 0.3, 1.6)});
  if (peaks.empty()) return std::nullopt;
  return PairPeak{refined(matcher, source_m, peaks.front().target_from_source.pose),
                  peaks.front().score};
}

/// The scan behind sees what the one ahead sees, not the other way round: a scanner that moves
/// away from what it sees has most of the second scan in unseen space, and a corridor then matches
/// best where it did not move. The clearly better match of both is taken.
std::optional<MatchedPair> match(CorrelativeMatcher& matcher, const ScanPair& pair,
                                 const AssumedBeams& beams, const LogCorrection& correction) {
  constexpr double kClearlyBetter = 0.05;
  const Pose2 by_odometry = motion_by_odometry(pair, correction);
  if (!is_within_reach(by_odometry)) return std::nullopt;
  const double turn_rad = std::abs(by_odometry.heading_rad);
  const auto ahead = best_match(matcher, pair.first, pair.second, beams, correction, turn_rad);
  const auto behind = best_match(matcher, pair.second, pair.first, beams, correction, turn_rad);
  if (!ahead && !behind) return std::nullopt;
  const bool takes_behind = behind && (!ahead || behind->score > ahead->score + kClearlyBetter);
  return MatchedPair{
      .by_odometry = by_odometry,
      .by_scans = takes_behind ? inverse(behind->target_from_source) : ahead->target_from_source,
      .score = takes_behind ? behind->score : ahead->score,
      .first_scan = pair.first_scan,
      .second_scan = pair.second_scan};
}

std::vector<MatchedPair> match_all(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                                   const LogCorrection& correction) {
  CorrelativeMatcher matcher(
      {.resolution_m = 0.1, .smear_sigma_m = 0.1, .heading_step_rad = 0.01, .min_score = 0.45});
  std::vector<MatchedPair> matched;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    auto found = match(matcher, pairs[i], beams, correction);
    if (!found) continue;
    found->number = i;
    matched.push_back(*found);
  }
  return matched;
}

std::vector<MatchedPair> turning(const std::vector<MatchedPair>& matched) {
  std::vector<MatchedPair> some;
  std::copy_if(matched.begin(), matched.end(), std::back_inserter(some),
               [](const MatchedPair& pair) {
                 return std::abs(pair.by_odometry.heading_rad) > kTurningRad &&
                        std::abs(pair.by_odometry.heading_rad) < 1.3;
               });
  return some;
}

double same_sign_share(const std::vector<MatchedPair>& turning_pairs) {
  if (turning_pairs.empty()) return 0.0;
  const auto same =
      std::count_if(turning_pairs.begin(), turning_pairs.end(), [](const MatchedPair& pair) {
        return pair.by_odometry.heading_rad * pair.by_scans.heading_rad > 0.0;
      });
  return static_cast<double>(same) / static_cast<double>(turning_pairs.size());
}

double turn_scale(const std::vector<MatchedPair>& turning_pairs) {
  std::vector<double> scales;
  scales.reserve(turning_pairs.size());
  for (const MatchedPair& pair : turning_pairs)
    scales.push_back(pair.by_scans.heading_rad / pair.by_odometry.heading_rad);
  return scales.size() < kFewestPairs ? 0.0 : geometry::upper_median(std::move(scales));
}

/// Whichever scale is nearer to 1: of the pairs that turn by odometry or of those that turn by
/// scans. Odometry whose noise is as large as the turns has turns too large in the former, and one
/// scan matched wrongly in the latter.
double turn_scale_of_both(const std::vector<MatchedPair>& matched) {
  std::vector<MatchedPair> by_scans = matched;
  for (MatchedPair& pair : by_scans) std::swap(pair.by_odometry, pair.by_scans);
  const double of_odometry = turn_scale(turning(matched));
  const double of_scans = turn_scale(turning(by_scans));
  if (of_odometry <= 0.0 || of_scans == 0.0) return of_odometry;
  if (of_scans < 0.0) return 0.0;
  const double inverse = 1.0 / of_scans;
  if ((of_odometry > 1.0) != (inverse > 1.0)) return 1.0;
  return of_odometry > 1.0 ? std::min(of_odometry, inverse) : std::max(of_odometry, inverse);
}

/// Pairs with straight motion by scans: the laser's position on the vehicle does not affect them.
std::vector<MatchedPair> straight(const std::vector<MatchedPair>& matched) {
  std::vector<MatchedPair> some;
  std::copy_if(matched.begin(), matched.end(), std::back_inserter(some),
               [](const MatchedPair& pair) {
                 return std::abs(pair.by_scans.heading_rad) < kStraightRad &&
                        pair.by_scans.translation_m().norm() > kMovingM &&
                        pair.by_odometry.translation_m().norm() > 0.0;
               });
  return some;
}

double way_scale(const std::vector<MatchedPair>& straight_pairs) {
  std::vector<double> scales;
  scales.reserve(straight_pairs.size());
  for (const MatchedPair& pair : straight_pairs)
    scales.push_back(pair.by_scans.translation_m().norm() /
                     pair.by_odometry.translation_m().norm());
  return scales.size() < kFewestPairs ? 0.0 : geometry::upper_median(std::move(scales));
}

/// Mean of exp(i (direction by odometry - direction by scans)) over straight pairs.
std::complex<double> mounting(const std::vector<MatchedPair>& straight_pairs) {
  std::complex<double> sum;
  for (const MatchedPair& pair : straight_pairs) {
    const std::complex<double> odometry(pair.by_odometry.x_m, pair.by_odometry.y_m);
    const std::complex<double> scans(pair.by_scans.x_m, pair.by_scans.y_m);
    sum += odometry / std::abs(odometry) * std::conj(scans / std::abs(scans));
  }
  return straight_pairs.empty() ? 0.0 : sum / static_cast<double>(straight_pairs.size());
}

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

/// How much walls bend with this layout; infinite if few walls are seen.
double bend_with(std::span<const std::vector<float>> scans_m, const AssumedBeams& beams) {
  constexpr std::size_t kFewestWalls = 20;
  const WallBend found = wall_bend(scans_m, beams.first_beam_rad, beams.beam_step_rad);
  return found.windows < kFewestWalls ? std::numeric_limits<double>::infinity()
                                      : std::abs(found.bend);
}

/// A wrong field of view scales the turns by scans, and bends walls. The turns raise the question,
/// and walls answer it: odometry's turns may err, too, and two scans that differ by a rotation
/// match with any field of view. An accepted factor must give a field of view of existing scanners.
double field_factor(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                    const LogCorrection& correction, const std::vector<MatchedPair>& as_stated) {
  constexpr double kTurnsAgree = 0.87;
  constexpr double kStraighter = 0.5;
  constexpr double kSameField = 0.02;  // 361 beams of half a degree are 180 degrees
  const double scale = std::abs(turn_scale(turning(as_stated)));
  if (pairs.empty() || !(scale > 0.0) || (scale > kTurnsAgree && scale < 1.0 / kTurnsAgree))
    return 1.0;
  const double stated_rad =
      std::abs(beams.beam_step_rad) * static_cast<double>(pairs.front().first.size());
  double best = 1.0;
  const auto scans_m = first_scans_m(pairs, correction.range_unit_m);
  double least_bend = kStraighter * bend_with(scans_m, beams);
  for (const double degrees : {90.0, 120.0, 180.0, 240.0, 270.0, 360.0}) {
    const double factor = degrees / 180.0 * pi / stated_rad;
    if (std::abs(factor - 1.0) < kSameField) continue;
    const double bend = bend_with(scans_m, with_field(beams, factor));
    if (bend >= least_bend) continue;
    best = factor;
    least_bend = bend;
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
  constexpr double kMostly = 0.8;
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

}  // namespace

Pose2 corrected(const LogCorrection& correction, const Pose2& recorded) {
  if (correction == LogCorrection{})
    return {recorded.x_m, recorded.y_m, wrap_angle(recorded.heading_rad)};
  const double y_m = correction.mirrors_position ? -recorded.y_m : recorded.y_m;
  const double heading_rad = recorded.heading_rad * correction.heading_unit_rad *
                             (correction.mirrors_heading ? -1.0 : 1.0);
  const geometry::Vector2 position_m =
      geometry::rotation(correction.position_turn_rad) *
      geometry::Vector2{correction.way_unit_m * recorded.x_m, correction.way_unit_m * y_m};
  return {position_m.x(), position_m.y(), wrap_angle(heading_rad)};
}

/// With turns of another size, each step bends by as much more or less.
Pose2 PoseCorrection::next(const LogCorrection& correction, const Pose2& recorded) {
  return turned(correction, recorded) * correction.odometry_from_base;
}

Pose2 PoseCorrection::turned(const LogCorrection& correction, const Pose2& recorded) {
  const Pose2 pose = in_order(correction, recorded);
  if (correction.turn_factor == 1.0) return pose;
  if (last_in_order_) {
    const Pose2 motion = inverse(*last_in_order_) * pose;
    const double turn_rad = correction.turn_factor * motion.heading_rad;
    const geometry::Vector2 moved_m =
        geometry::rotation(0.5 * (turn_rad - motion.heading_rad)) * motion.translation_m();
    last_turned_ = last_turned_ * Pose2{moved_m.x(), moved_m.y(), turn_rad};
  } else {
    last_turned_ = pose;
  }
  last_in_order_ = pose;
  return last_turned_;
}

Pose2 PoseCorrection::in_order(const LogCorrection& correction, const Pose2& recorded) {
  if (!correction.integrates_turns_anew) return corrected(correction, recorded);
  const Pose2 in_units{correction.way_unit_m * recorded.x_m, correction.way_unit_m * recorded.y_m,
                       recorded.heading_rad * correction.heading_unit_rad};
  if (last_recorded_) {
    Pose2 motion = inverse(*last_recorded_) * in_units;
    motion.heading_rad = -motion.heading_rad;
    last_ = last_ * motion;
  }
  last_recorded_ = in_units;
  return last_;
}

void OdometryCheck::add(const Pose2& recorded) {
  largest_heading_ = std::max(largest_heading_, std::abs(recorded.heading_rad));
  const std::optional<Pose2> before = before_;
  before_ = recorded;
  if (!before) return;
  const double way = std::hypot(recorded.x_m - before->x_m, recorded.y_m - before->y_m);
  if (!(way > 0.0)) return;
  const double direction = std::atan2(recorded.y_m - before->y_m, recorded.x_m - before->x_m);
  for (Unit& unit : units_) {
    const double turn = wrap_angle((recorded.heading_rad - before->heading_rad) * unit.radians);
    const double heading = before->heading_rad * unit.radians + 0.5 * turn;
    unit.along += way * std::polar(1.0, 2.0 * (direction - heading));
    unit.mirrored += way * std::polar(1.0, 2.0 * (direction + heading));
    const double forward = std::cos(direction - heading) < 0.0 ? pi : 0.0;
    if (std::abs(turn) > 0.5) continue;
    unit.arc += way * std::sin(direction - heading - forward) * turn;
    unit.arc_turn += way * turn * turn;
    const double from_heading = direction - before->heading_rad * unit.radians;
    const double sideways = way * std::sin(from_heading);
    const Eigen::Vector2d by(turn, way * std::cos(from_heading) * turn);
    unit.turning += by * by.transpose();
    unit.sideways += sideways * by;
    unit.squared_sideways += sideways * sideways;
    ++unit.steps;
  }
  way_ += way;
}

bool OdometryCheck::is_in_degrees() const {
  constexpr double kOneTurn = 6.5;
  if (largest_heading_ < kOneTurn || way_ <= 0.0) return false;
  const auto fit = [&](const Unit& unit) {
    return std::max(std::abs(unit.along), std::abs(unit.mirrored)) / way_;
  };
  return fit(units_[1]) > fit(units_[0]) + kClearly;
}

bool OdometryCheck::positions_are_mirrored() const {
  if (way_ <= 0.0) return false;
  // On streets that cross at right angles both are consistent, but one fits far less exactly.
  constexpr double kSpreadShare = 0.25;
  constexpr double kLeastSpread = 1e-3;
  const double mirrored = std::abs(unit().mirrored) / way_;
  const double along = std::abs(unit().along) / way_;
  return mirrored > kConsistent && 1.0 - along > kLeastSpread &&
         1.0 - mirrored < kSpreadShare * (1.0 - along);
}

/// Mean offset of chords against the arc. 0: chords lie along the heading in their middle, as on
/// arcs. -0.5: chords lie along the first heading. Lower if positions are later than headings,
/// higher if they are earlier. With the wrong turn sign, a becomes -1 - a.
double OdometryCheck::arcs_per_turn() const {
  return unit().arc_turn > 0.0 ? unit().arc / unit().arc_turn : kEitherWay;
}

/// Distance of the reference point ahead of the turning axle, if it is as large as on cars. A point
/// c ahead moves sideways by c times the turn, into the turn. With the wrong turn sign it is -c,
/// and no car steers from behind its axle.
std::optional<double> OdometryCheck::ahead_of_axle_m(double unit_m) const {
  constexpr double kOfCars_m = 0.3;
  constexpr double kSigmas = 5.0;
  constexpr double kLeastDistinct = 1e-6;  // at one speed an offset cannot be told from a delay
  const Eigen::Matrix2d& turning = unit().turning;
  if (unit().steps < 3 || !(turning.determinant() > kLeastDistinct * turning(0, 0) * turning(1, 1)))
    return std::nullopt;
  const Eigen::Matrix2d covariance = turning.inverse();
  const Eigen::Vector2d fit = covariance * unit().sideways;
  const double variance =
      std::max(unit().squared_sideways - fit.dot(unit().sideways), 0.0) / (unit().steps - 2);
  const bool is_seen = std::abs(fit.x()) > kSigmas * std::sqrt(variance * covariance(0, 0));
  return is_seen && std::abs(fit.x()) * unit_m > kOfCars_m ? std::optional(fit.x() * unit_m)
                                                           : std::nullopt;
}

bool OdometryCheck::turns_against_its_arcs(double unit_m) const {
  if (const auto ahead_m = ahead_of_axle_m(unit_m)) return *ahead_m < 0.0;
  return std::abs(arcs_per_turn() + 1.0) < kArcsSeen || arcs_per_turn() > kArcsSeen;
}

bool OdometryCheck::turns_with_its_arcs(double unit_m) const {
  if (const auto ahead_m = ahead_of_axle_m(unit_m)) return *ahead_m > 0.0;
  return std::abs(arcs_per_turn()) < kArcsSeen || arcs_per_turn() < -1.0 - kArcsSeen;
}

double OdometryCheck::mirrored_direction_rad() const { return 0.5 * std::arg(unit().mirrored); }

double range_unit_of(double median_reading, double far_reading) {
  constexpr double kNoScannersMedian = 100.0;
  constexpr double kLeastFarMillimetres = 2500.0;
  if (median_reading < kNoScannersMedian) return 1.0;
  return far_reading > kLeastFarMillimetres ? 1e-3 : 1e-2;
}

namespace {

constexpr double kTurnedSeen_rad = 0.4;  // of a scanner: by single pairs; less needs all of them
constexpr double kOtherSize = 0.15;      // of turns; less is learned during the drive

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

/// A scanner turned a little, and odometry of another point of the vehicle: each where the pairs
/// determine it well enough to tell it from none.
void place_odometry(const std::optional<OdometryPoint>& point, const AssumedBeams& beams,
                    LogCorrection& correction) {
  constexpr double kTurned_rad = 0.02;
  constexpr double kApart_m = 0.2;
  constexpr double kSigmas = 4.0;
  constexpr double kMostSigma_rad = 0.02;  // more, and pairs were matched wrongly
  constexpr double kMostSigma_m = 0.3;
  if (!point || point->sigma.heading_rad > kMostSigma_rad) return;
  const Pose2& found = point->odometry_from_laser;
  const double turned_rad = wrap_angle(found.heading_rad - beams.laser_heading_rad);
  if (correction.laser_turn_rad == 0.0 && std::abs(turned_rad) < kTurnedSeen_rad &&
      std::abs(turned_rad) > std::max(kTurned_rad, kSigmas * point->sigma.heading_rad))
    correction.laser_turn_rad = turned_rad;
  const geometry::Vector2 apart_m = found.translation_m() - beams.laser_in_base_m;
  const double sigma_m = std::hypot(point->sigma.x_m, point->sigma.y_m);
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
  const auto tried = std::ranges::count_if(pairs, [&](const ScanPair& pair) {
    return is_within_reach(motion_by_odometry(pair, correction));
  });
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
  const std::complex<double> mounted =
      mounting(straight_pairs) * std::polar(1.0, -beams.laser_heading_rad);
  const double turn_rad = std::arg(mounted);
  if (straight_pairs.size() >= kFewestPairs && std::abs(mounted) > kConsistent &&
      std::abs(turn_rad) > kTurnedSeen_rad) {
    if (correction.mirrors_position != correction.mirrors_heading) {
      correction.position_turn_rad =
          wrap_angle(correction.position_turn_rad - at_right_angle(turn_rad));
    } else {
      correction.laser_turn_rad = at_right_angle(turn_rad);
    }
  }
  for (const MatchedPair& pair : matched)
    evidence.motions.push_back({pair.first_scan, pair.second_scan, pair.by_scans.heading_rad,
                                pair.by_scans.translation_m().norm()});
  std::optional<OdometryPoint> point = odometry_point(
      looked_at, with_field(beams, correction.field_factor), correction.range_unit_m, matched);
  if (point && way_has_the_wrong_sign(*point, beams, correction)) {
    correction.laser_turn_rad = 0.0;
    correction.position_turn_rad = wrap_angle(correction.position_turn_rad + pi);
    point->odometry_from_laser = Pose2{0.0, 0.0, pi} * point->odometry_from_laser;
  }
  place_odometry(point, beams, correction);
  evidence.way_scale = way_scale(straight_pairs);
  evidence.turn_scale = turn_scale_of_both(matched);
  if (evidence.turn_scale > 0.0 && std::abs(evidence.turn_scale - 1.0) > kOtherSize)
    correction.turn_factor = evidence.turn_scale;
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

}  // namespace slammot::matching
