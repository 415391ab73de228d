#include "common/matching/log_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using std::numbers::pi;
using testing::PoseNear;

constexpr std::size_t kBeams = 181;

/// Range from (x, y) along a direction to the walls of a room with a niche, so that no two corners
/// look alike.
double range_m(double x_m, double y_m, double direction_rad) {
  const double dx = std::cos(direction_rad);
  const double dy = std::sin(direction_rad);
  for (double range = 0.05; range < 40.0; range += 0.01) {
    const double px = x_m + range * dx;
    const double py = y_m + range * dy;
    const bool is_in_niche = px > 6.0 && px < 8.5 && py < 7.0;
    if (px < -4.0 || px > 12.0 || py < -5.0 || (py > 4.0 && !is_in_niche) || py > 7.0 ||
        std::hypot(px - 9.0, py + 2.0) < 0.6)
      return range;
  }
  return 40.0;
}

std::vector<float> scan_at(const Pose2& pose, double field_rad, std::size_t beams = kBeams) {
  std::vector<float> ranges;
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle =
        -0.5 * field_rad + field_rad * static_cast<double>(i) / static_cast<double>(beams - 1);
    ranges.push_back(static_cast<float>(range_m(pose.x_m, pose.y_m, pose.heading_rad + angle)));
  }
  return ranges;
}

/// A drive once around, straight and turning in turns.
std::vector<Pose2> drive() {
  std::vector<Pose2> poses{{2.0, -2.0, 0.3}};
  for (int i = 0; i < 40; ++i) {
    const double turn = i % 2 == 0 ? 0.02 : 0.28;
    const Pose2 step{0.28, 0.28 * 0.5 * turn, turn};
    poses.push_back(poses.back() * step);
  }
  return poses;
}

struct Recording {
  std::function<Pose2(const Pose2&)> pose = [](const Pose2& pose) { return pose; };
  std::function<void(std::vector<float>&)> scan = [](std::vector<float>&) {};
  double field_rad = pi;
  double looks_rad = 0.0;
  double range_unit_m = 1.0;
  double ahead_m = 0.0;  // of the base is the laser, as is said
  std::size_t beams = kBeams;
};

/// Evidence of the drive, recorded in some way, where a half circle is assumed.
LogEvidence evidence_of(const Recording& recording) {
  std::vector<ScanPair> pairs;
  OdometryCheck check;
  std::optional<ScanPair> before;
  for (const Pose2& pose : drive()) {
    ScanPair now;
    now.first = scan_at(pose * Pose2{recording.ahead_m, 0.0, recording.looks_rad},
                        recording.field_rad, recording.beams);
    recording.scan(now.first);
    now.first_recorded = recording.pose(pose);
    check.add(now.first_recorded);
    if (before)
      pairs.push_back({before->first, now.first, before->first_recorded, now.first_recorded});
    before = now;
  }
  return weigh_log(
      pairs,
      {-0.5 * pi, pi / static_cast<double>(recording.beams - 1), 0.0, {recording.ahead_m, 0.0}},
      check, recording.range_unit_m);
}

TEST(WeighLog, CorrectsNothingOfASoundLog) {
  const LogEvidence evidence = evidence_of({});
  EXPECT_EQ(evidence.correction, LogCorrection{});
  EXPECT_GT(evidence.matched_share, 0.9);
  EXPECT_GT(evidence.turn_sign_share, 0.9);
  EXPECT_NEAR(evidence.turn_scale, 1.0, 0.1);
}

/// Range in a corridor 2 m wide, with niches every 7 m.
float range_in_corridor_m(double x_m, double direction_rad) {
  const double dx = std::cos(direction_rad);
  const double dy = std::sin(direction_rad);
  for (double range = 0.05; range < 8.0; range += 0.01) {
    const double px = x_m + range * dx;
    const double py = range * dy;
    const double into_niche_m = px - 7.0 * std::floor(px / 7.0);
    if (std::abs(py) > (into_niche_m < 2.0 ? 2.0 : 1.0)) return static_cast<float>(range);
  }
  return std::numeric_limits<float>::quiet_NaN();
}

/// Of steps of this length, as a robot takes them that logs a scan a metre.
double way_scale_in_corridor(double step_m) {
  std::vector<ScanPair> pairs;
  OdometryCheck check;
  for (int i = 0; i < 20; ++i) {
    const double x_m = 7.0 * i + 5.0;  // the next niche is 2 m ahead
    ScanPair pair;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const double angle_rad = -0.5 * pi + pi * static_cast<double>(beam) / (kBeams - 1);
      pair.first.push_back(range_in_corridor_m(x_m, angle_rad));
      pair.second.push_back(range_in_corridor_m(x_m + step_m, angle_rad));
    }
    pair.first_recorded = {x_m, 0.0, 0.0};
    pair.second_recorded = {x_m + step_m, 0.0, 0.0};
    check.add(pair.first_recorded);
    pairs.push_back(pair);
  }
  return weigh_log(pairs, {-0.5 * pi, pi / static_cast<double>(kBeams - 1), 0.0}, check, 1.0)
      .way_scale;
}

TEST(WeighLog, TellsTheWayOfAVehicleThatBacksAwayFromWhatItSees) {
  EXPECT_NEAR(way_scale_in_corridor(1.0), 1.0, 0.1);
  EXPECT_NEAR(way_scale_in_corridor(-1.0), 1.0, 0.1);
}

TEST(WeighLog, FindsBeamsThatGoClockwise) {
  LogCorrection expected;
  expected.reverses_beams = true;
  const LogEvidence evidence = evidence_of(
      {.scan = [](std::vector<float>& ranges) { std::reverse(ranges.begin(), ranges.end()); }});
  EXPECT_EQ(evidence.correction, expected);
  EXPECT_TRUE(evidence.handedness_is_told);
}

/// The poses of the drive put together again from other steps.
std::function<Pose2(const Pose2&)> redriven(const std::function<Pose2(const Pose2&)>& step) {
  return [=, before = std::optional<Pose2>(), now = Pose2::identity()](const Pose2& pose) mutable {
    if (before) now = now * step(inverse(*before) * pose);
    before = pose;
    return now;
  };
}

std::function<Pose2(const Pose2&)> turned_more(double factor) {
  return redriven([=](const Pose2& step) {
    return Pose2{step.x_m, step.y_m, factor * step.heading_rad};
  });
}

TEST(WeighLog, DoesNotTurnTheLaserWhereWaysGoInAllDirections) {
  const auto evidence = evidence_of(
      {.pose = redriven([count = 0](const Pose2& step) mutable {
         const double aside_rad = 2.4 * count++;
         const double way_m = step.translation_m().norm();
         return Pose2{way_m * std::cos(aside_rad), way_m * std::sin(aside_rad), step.heading_rad};
       })});
  EXPECT_GT(evidence.pairs, 20U);
  EXPECT_EQ(evidence.correction.laser_turn_rad, 0.0);
  EXPECT_EQ(evidence.correction.position_turn_rad, 0.0);
}

TEST(WeighLog, MirrorsOdometryThatTurnsAgainstItsOwnArcs) {
  const LogEvidence evidence = evidence_of({.pose = turned_more(-1.0)});
  EXPECT_TRUE(evidence.correction.mirrors_position);
  EXPECT_TRUE(evidence.correction.mirrors_heading);
  EXPECT_FALSE(evidence.correction.reverses_beams);
  EXPECT_EQ(evidence.correction.odometry_from_base, Pose2::identity());
  EXPECT_TRUE(evidence.handedness_is_told);
}

TEST(WeighLog, FindsTurnsOfAnotherSize) {
  for (const double factor : {0.7, 1.3})
    EXPECT_NEAR(evidence_of({.pose = turned_more(factor)}).correction.turn_factor * factor, 1.0,
                0.05);
  EXPECT_EQ(evidence_of({.pose = turned_more(1.08)}).correction.turn_factor, 1.0)
      << "is learned during the drive";
}

TEST(WeighLog, DoesNotTakeNoiseOfOdometryForTurnsOfAnotherSize) {
  const LogEvidence evidence = evidence_of({.pose = [count = 0](const Pose2& pose) mutable {
    return pose * Pose2{0.0, 0.0, 0.2 * std::sin(2.4 * count++)};
  }});
  EXPECT_EQ(evidence.correction.turn_factor, 1.0);
  EXPECT_NEAR(evidence.turn_scale, 1.0, 0.1);
}

/// A vehicle that hardly turns, with the headings of a compass.
TEST(WeighLog, SaysNothingOfTurnsThatAreAllNoise) {
  std::vector<ScanPair> pairs;
  OdometryCheck check;
  Pose2 before{2.0, -2.0, 0.3};
  for (int i = 0; i < 40; ++i) {
    const Pose2 now = before * Pose2{0.28, 0.0014, 0.01};
    const double turn_rad = i % 5 < 3 ? 0.3 : -0.3;  // three of five to the true side
    const Pose2 recorded{now.x_m, now.y_m, before.heading_rad + turn_rad};
    check.add(recorded);
    pairs.push_back({scan_at(before, pi), scan_at(now, pi), before, recorded});
    before = now;
  }
  const LogEvidence evidence = weigh_log(
      pairs, {-0.5 * pi, pi / static_cast<double>(kBeams - 1), 0.0, {0.0, 0.0}}, check, 1.0);
  EXPECT_EQ(evidence.correction.turn_factor, 1.0);
  EXPECT_EQ(evidence.turn_scale, 0.0);
}

TEST(WeighLog, FindsAScannerThatIsTurnedALittle) {
  EXPECT_NEAR(evidence_of({.looks_rad = 0.1}).correction.laser_turn_rad, 0.1, 0.02);
  EXPECT_EQ(evidence_of({.looks_rad = 0.005}).correction.laser_turn_rad, 0.0);
}

TEST(WeighLog, FindsNoPointOfOdometryAmongMatchesThatScatter) {
  std::mt19937 random(5);
  std::normal_distribution<double> error_m(0.0, 0.4);
  const LogEvidence evidence = evidence_of({.pose = [&](const Pose2& pose) {
    return pose * Pose2{error_m(random), error_m(random), 0.0};
  }});
  EXPECT_EQ(evidence.correction.odometry_from_base, Pose2::identity());
  EXPECT_EQ(evidence.correction.laser_turn_rad, 0.0);
}

TEST(WeighLog, FindsThePointThatOdometrySpeaksOf) {
  const Pose2 base_from_odometry{-1.2, 0.5, 0.0};
  const LogEvidence evidence =
      evidence_of({.pose = [&](const Pose2& pose) { return pose * base_from_odometry; }});
  EXPECT_THAT(evidence.correction.odometry_from_base, PoseNear(Pose2{1.2, -0.5, 0.0}, 0.1));
  EXPECT_EQ(evidence.correction.laser_turn_rad, 0.0);
  PoseCorrection correction;
  for (const Pose2& pose : drive())
    EXPECT_THAT(correction.next({.odometry_from_base = inverse(base_from_odometry)},
                                pose * base_from_odometry),
                PoseNear(pose, 1e-9));
}

TEST(PoseCorrection, GivesTurnsTheirSizeBack) {
  auto recorded = turned_more(1.3);
  PoseCorrection correction;
  std::optional<Pose2> before, corrected_before;
  for (const Pose2& pose : drive()) {
    const Pose2 corrected = correction.next({.turn_factor = 1.0 / 1.3}, recorded(pose));
    if (before) {
      const Pose2 step = inverse(*corrected_before) * corrected;
      const Pose2 true_step = inverse(*before) * pose;
      EXPECT_NEAR(step.heading_rad, true_step.heading_rad, 1e-9);
      EXPECT_NEAR(step.translation_m().norm(), true_step.translation_m().norm(), 1e-9);
    }
    before = pose;
    corrected_before = corrected;
  }
}

TEST(WeighLog, LeavesBeamsWhereOdometryHidesTheArcsOfItsTurns) {
  const LogEvidence evidence = evidence_of({.pose = redriven([](const Pose2& step) {
                                              return Pose2{step.x_m, 0.0, -step.heading_rad};
                                            })});
  EXPECT_TRUE(evidence.correction.mirrors_position);
  EXPECT_TRUE(evidence.correction.mirrors_heading);
  EXPECT_FALSE(evidence.correction.reverses_beams);
  EXPECT_FALSE(evidence.handedness_is_told);
}

TEST(WeighLog, FindsHeadingsOfTheWrongSign) {
  const LogCorrection correction = evidence_of({.pose = [](const Pose2& pose) {
                                     return Pose2{pose.x_m, pose.y_m, -pose.heading_rad};
                                   }}).correction;
  EXPECT_TRUE(correction.mirrors_heading);
  EXPECT_FALSE(correction.mirrors_position);
  EXPECT_FALSE(correction.reverses_beams);
}

/// Clockwise from north, or from south: positions do not say which, a scanner that looks ahead
/// does.
TEST(WeighLog, FindsHeadingsOfACompass) {
  for (const double north_rad : {0.5 * pi, -0.5 * pi}) {
    const LogCorrection correction =
        evidence_of({.pose =
                         [=](const Pose2& pose) {
                           return Pose2{pose.x_m, pose.y_m, north_rad - pose.heading_rad};
                         },
                     .ahead_m = 1.5})
            .correction;
    EXPECT_TRUE(correction.mirrors_heading) << north_rad;
    EXPECT_NEAR(correction.position_turn_rad, -north_rad, 0.05);
    EXPECT_EQ(correction.laser_turn_rad, 0.0) << north_rad;
    EXPECT_EQ(correction.odometry_from_base, Pose2::identity()) << north_rad;
  }
}

TEST(WeighLog, FindsSwappedAxes) {
  const LogCorrection correction = evidence_of({.pose = [](const Pose2& pose) {
                                     return Pose2{pose.y_m, pose.x_m, pose.heading_rad};
                                   }}).correction;
  EXPECT_TRUE(correction.mirrors_position);
  EXPECT_FALSE(correction.mirrors_heading);
  const auto poses = drive();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto recorded = [&](std::size_t at) {
      return corrected(correction, {poses[at].y_m, poses[at].x_m, poses[at].heading_rad});
    };
    EXPECT_THAT(inverse(recorded(i - 1)) * recorded(i),
                PoseNear(inverse(poses[i - 1]) * poses[i], 0.02));
  }
}

TEST(WeighLog, FindsUnits) {
  EXPECT_EQ(evidence_of({.pose =
                             [](const Pose2& pose) {
                               return Pose2{1e3 * pose.x_m, 1e3 * pose.y_m, pose.heading_rad};
                             }})
                .correction.way_unit_m,
            1e-3);
  const auto in = [](float units) {
    return [=](std::vector<float>& ranges) {
      for (float& range : ranges) range *= units;
    };
  };
  EXPECT_EQ(evidence_of({.scan = in(1000.0F), .range_unit_m = 1e-3}).correction.range_unit_m, 1e-3);
  EXPECT_EQ(evidence_of({.scan = in(100.0F), .range_unit_m = 1e-3}).correction.range_unit_m, 1e-2);
  EXPECT_EQ(evidence_of({.scan = in(1000.0F), .range_unit_m = 1e-2}).correction.range_unit_m, 1e-3);
}

TEST(WeighLog, FindsTheFieldOfView) {
  const LogCorrection correction = evidence_of({.field_rad = 0.5 * pi}).correction;
  EXPECT_NEAR(correction.field_factor, 0.5, 0.02);
  EXPECT_FALSE(correction.reverses_beams);
}

TEST(WeighLog, FindsTheFieldOfViewByWallsWhereOdometryTurnsTooMuchOrTooLittle) {
  for (const double factor : {0.8, 1.15, 1.3}) {
    const auto turns_more = turned_more(factor);
    EXPECT_NEAR(evidence_of({.pose = turns_more, .field_rad = 0.5 * pi}).correction.field_factor,
                0.5, 0.02)
        << factor;
    EXPECT_EQ(evidence_of({.pose = turns_more}).correction.field_factor, 1.0) << factor;
  }
}

TEST(WeighLog, KeepsTheFieldOfViewWhereTooFewWallsTell) {
  const auto sees_near = [](std::vector<float>& ranges) {  // of each wall a few beams
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (i % 16 > 12) ranges[i] = 0.0F;
  };
  EXPECT_EQ(evidence_of({.pose = turned_more(1.3), .scan = sees_near}).correction.field_factor,
            1.0);
}

TEST(WeighLog, FindsTheFieldOfAScannerOf100DegreesByWallsAndBeams) {
  const LogCorrection correction =
      evidence_of({.pose = turned_more(1.05), .field_rad = pi * 100.0 / 180.0, .beams = 101})
          .correction;
  EXPECT_NEAR(correction.field_factor, 100.0 / 180.0, 0.01);
  EXPECT_NEAR(evidence_of({.field_rad = 0.5 * pi, .beams = 91}).correction.field_factor, 0.5, 0.01);
}

TEST(WeighLog, KeepsAFieldOfViewThatIsOneBeamWiderThanAUsualOne) {
  constexpr double kOneBeamLess_rad = pi * (kBeams - 1) / kBeams;
  EXPECT_EQ(evidence_of({.pose = turned_more(1.3), .field_rad = kOneBeamLess_rad})
                .correction.field_factor,
            1.0);
}

TEST(WeighLog, TellsAWayWithTheWrongSignFromAScannerThatLooksBackwards) {
  const auto reversed = redriven([](const Pose2& step) {
    return Pose2{-step.x_m, -step.y_m, step.heading_rad};
  });
  const LogCorrection correction = evidence_of({.pose = reversed, .ahead_m = 1.0}).correction;
  EXPECT_EQ(correction.laser_turn_rad, 0.0);
  EXPECT_NEAR(std::abs(correction.position_turn_rad), pi, 1e-9);
  EXPECT_EQ(correction.odometry_from_base, Pose2::identity());
  const LogCorrection turned = evidence_of({.looks_rad = pi, .ahead_m = 1.0}).correction;
  EXPECT_NEAR(std::abs(turned.laser_turn_rad), pi, 1e-9);
  EXPECT_EQ(turned.position_turn_rad, 0.0);
}

TEST(WeighLog, FindsAScannerThatLooksBackwards) {
  EXPECT_NEAR(std::abs(evidence_of({.looks_rad = pi}).correction.laser_turn_rad), pi, 1e-9);
}

TEST(WeighLog, ConcludesNothingFromPairsThatAreFartherApartThanItLooks) {
  const auto evidence_at = [](double step_m) {
    const auto corridor = scan_at({2.0, -0.5, 0.0}, pi);  // looks the same all along
    std::vector<ScanPair> pairs;
    for (int i = 0; i < 20; ++i)
      pairs.push_back({corridor, corridor, {step_m * i, 0.0, 0.0}, {step_m * (i + 1), 0.0, 0.0}});
    return weigh_log(pairs, {-0.5 * pi, pi / static_cast<double>(kBeams - 1), 0.0}, {}, 1.0);
  };
  EXPECT_EQ(evidence_at(1.0).pairs, 20U);
  EXPECT_EQ(evidence_at(5.0).pairs, 0U);
  EXPECT_EQ(evidence_at(5.0).way_scale, 0.0);
}

TEST(WeighLog, ConcludesNothingFromFewPairs) {
  const ScanPair pair{scan_at({}, pi), scan_at({0.2, 0.0, 0.1}, pi), {}, {0.2, 0.0, -0.1}};
  EXPECT_EQ(weigh_log(std::vector<ScanPair>(3, pair), {-0.5 * pi, pi / 180.0}, {}, 1.0).correction,
            LogCorrection{});
  EXPECT_EQ(weigh_log({}, {-0.5 * pi, pi / 180.0}, {}, 1.0).pairs, 0u);
}

TEST(RangeUnitOf, IsMetresUnlessNoScannerSeesSoFar) {
  EXPECT_EQ(range_unit_of(30.0, 80.0), 1.0);
  EXPECT_EQ(range_unit_of(2'000.0, 6'000.0), 1e-3);
  EXPECT_EQ(range_unit_of(300.0, 900.0), 1e-2);
}

}  // namespace
}  // namespace slammot::matching
