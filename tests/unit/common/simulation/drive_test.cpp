#include "common/simulation/drive.hpp"
#include "services/simulator/scenario_files.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

ScenarioConfig short_drive(std::uint64_t seed) {
  ScenarioConfig scenario = *simulator::load_scenario("block", seed);
  scenario.duration_s = 4.0;
  return scenario;
}

std::vector<SimulatedScan> all_scans(const ScenarioConfig& scenario) {
  std::vector<SimulatedScan> scans;
  Drive drive(scenario);
  while (auto scan = drive.next()) scans.push_back(std::move(*scan));
  return scans;
}

TEST(Drive, IsTheSameToTheLastBitForTheSameSeed) {
  const auto first = all_scans(short_drive(5));
  const auto second = all_scans(short_drive(5));
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].scan.range_m, second[i].scan.range_m);
    EXPECT_TRUE(first[i].odometry.wheel_from_base == second[i].odometry.wheel_from_base);
    EXPECT_TRUE(first[i].world_from_base == second[i].world_from_base);
  }
}

TEST(Drive, DiffersFromSeedToSeed) {
  EXPECT_NE(all_scans(short_drive(5)).back().scan.range_m,
            all_scans(short_drive(6)).back().scan.range_m);
}

TEST(Drive, HasOneScanForEachTurnOfTheScannerWithStampsInOrder) {
  const auto scans = all_scans(short_drive(1));
  ASSERT_EQ(scans.size(), 150U);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i].scan.sequence, i);
    EXPECT_NEAR(static_cast<double>(scans[i].scan.stamp_ns) * 1e-9,
                21.0 + static_cast<double>(i) / 37.5, 1e-8);
    EXPECT_EQ(scans[i].odometry.stamp_ns, scans[i].scan.stamp_ns);
  }
}

TEST(Drive, StartsItsOdometryAtZero) {
  EXPECT_TRUE(all_scans(short_drive(1)).front().odometry.wheel_from_base ==
              geometry::Pose2::identity());
}

TEST(Drive, ListsEachObjectThatAScanHitOnceWithItsPoints) {
  std::size_t listed = 0;
  for (const SimulatedScan& scan : all_scans(short_drive(1))) {
    std::set<int> ids;
    for (const ObjectTruth& object : scan.objects) {
      EXPECT_TRUE(ids.insert(object.id).second);
      EXPECT_GT(object.id, 0);  // the vehicle does not see itself
      EXPECT_GE(object.points, 1);
      ++listed;
    }
  }
  EXPECT_GT(listed, 0U);
}

/// Fraction of the points, placed by the true pose, that lie near a true surface or object: what
/// the truth is worth.
TEST(Drive, PlacesItsPointsOnTrueSurfaces) {
  const ScenarioConfig scenario = short_drive(1);
  Drive drive(scenario);
  const Outline outline = drive.stationary_in_world();
  int near = 0;
  int stationary_echoes = 0;
  while (const auto scan = drive.next()) {
    if (scan->scan.sequence % 30 != 0) continue;
    const auto count = scan->scan.range_m.size();
    for (std::size_t beam = 0; beam < count; beam += 5) {
      if (!sensing::is_echo(scan->scan.range_m[beam], scan->scan.scanner.max_range_m)) continue;
      const double range_m = scan->scan.range_m[beam];
      const double angle_rad = beam_angle_rad(scan->scan.scanner, beam);
      const geometry::Pose2 world_from_laser =
          scan->world_from_base * scan->scan.scanner.base_from_laser;
      const geometry::Vector2 point =
          world_from_laser *
          geometry::Vector2{range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)};
      double nearest_m = 1e9;
      for (const Segment& segment : outline.segments) {
        const geometry::Vector2 along = segment.b - segment.a;
        const double t = std::clamp((point - segment.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest_m = std::min(nearest_m, (point - segment.a - t * along).norm());
      }
      for (const Circle& circle : outline.circles) {
        nearest_m = std::min(nearest_m, std::abs((point - circle.centre).norm() - circle.radius_m));
      }
      for (const ObjectTruth& object : scan->objects) {
        const geometry::Vector2 in_object = inverse(object.world_from_object) * point;
        const bool inside = std::abs(in_object.x()) < 0.5 * object.size.length_m + 0.5 &&
                            std::abs(in_object.y()) < 0.5 * object.size.width_m + 0.5;
        if (inside) nearest_m = 0.0;
      }
      ++stationary_echoes;
      near += nearest_m < 0.4 ? 1 : 0;
    }
  }
  // The rest are mixed pixels and the road.
  EXPECT_GT(static_cast<double>(near) / stationary_echoes, 0.9);
}

TEST(Drive, SaysWhichObjectEachBeamHit) {
  for (const SimulatedScan& scan : all_scans(short_drive(1))) {
    ASSERT_EQ(scan.hits.size(), scan.scan.range_m.size());
    for (const ObjectTruth& object : scan.objects)
      EXPECT_EQ(std::ranges::count(scan.hits, object.id), object.points);
    for (const int hit : scan.hits)
      if (hit > 0)
        EXPECT_TRUE(std::ranges::any_of(scan.objects, [&](const ObjectTruth& object) {
          return object.id == hit;
        })) << hit;
    for (std::size_t beam = 0; beam < scan.hits.size(); ++beam) {
      const bool is_echo = sensing::is_echo(scan.scan.range_m[beam], scan.scan.scanner.max_range_m);
      EXPECT_EQ(is_echo, scan.hits[beam] != kHitNothing);
    }
  }
}

TEST(Drive, KnowsAlsoWhoIsNotSeen) {
  const auto scans = all_scans(short_drive(1));
  const std::size_t all = scans[0].objects.size() + scans[0].unseen.size();
  EXPECT_GT(scans[0].unseen.size(), 0U);
  for (const SimulatedScan& scan : scans) EXPECT_EQ(scan.objects.size() + scan.unseen.size(), all);
}

/// A scanner at the back that looks backwards, a third as often, begun later.
ScannerConfig rear_scanner() {
  ScannerConfig rear;
  rear.scanner_id = "rear";
  rear.ahead_m = -2.2;
  rear.heading_rad = std::numbers::pi;
  rear.rate_hz = 12.5;
  rear.delay_s = 0.01;
  return rear;
}

TEST(Drive, HasFurtherScannersBesideTheFirstWhichStaysAsItWas) {
  ScenarioConfig scenario = short_drive(1);
  const auto alone = all_scans(scenario);
  scenario.more_scanners = {rear_scanner()};
  const auto both = all_scans(scenario);
  EXPECT_TRUE(std::ranges::is_sorted(both, {},
                                     [](const SimulatedScan& scan) { return scan.scan.stamp_ns; }));
  std::vector<SimulatedScan> front, rear;
  for (const SimulatedScan& scan : both) (scan.scanner == 0 ? front : rear).push_back(scan);
  ASSERT_EQ(front.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i)
    EXPECT_EQ(front[i].scan.range_m, alone[i].scan.range_m);
  ASSERT_EQ(rear.size(), 50U);
  for (std::size_t i = 0; i < rear.size(); ++i) {
    EXPECT_EQ(rear[i].scan.sequence, i);
    EXPECT_NEAR(static_cast<double>(rear[i].scan.stamp_ns) * 1e-9,
                21.01 + static_cast<double>(i) / 12.5, 1e-8);
    EXPECT_EQ(rear[i].scan.scanner.scanner_id, "rear");
    EXPECT_EQ(rear[i].odometry.stamp_ns, rear[i].scan.stamp_ns);
  }
}

TEST(Drive, TellsTheTruthAtTheStampsOfFurtherScanners) {
  ScenarioConfig scenario = short_drive(1);
  scenario.more_scanners = {rear_scanner()};
  const auto scans = all_scans(scenario);
  for (std::size_t i = 1; i + 1 < scans.size(); ++i) {
    if (scans[i].scanner == 0) continue;
    const auto &before = scans[i - 1], &after = scans[i + 1];
    const double fraction = static_cast<double>(scans[i].scan.stamp_ns - before.scan.stamp_ns) /
                            static_cast<double>(after.scan.stamp_ns - before.scan.stamp_ns);
    const auto between = interpolate(before.world_from_base, after.world_from_base, fraction);
    EXPECT_LT((between.translation_m() - scans[i].world_from_base.translation_m()).norm(), 1e-6);
    const auto wheels =
        interpolate(before.odometry.wheel_from_base, after.odometry.wheel_from_base, fraction);
    EXPECT_LT((wheels.translation_m() - scans[i].odometry.wheel_from_base.translation_m()).norm(),
              1e-6);
  }
}

TEST(Drive, HasReceiverAndCompassAtTheirOwnRates) {
  ScenarioConfig scenario = short_drive(1);
  const auto without = all_scans(scenario);
  scenario.gnss.rate_hz = 2.0;
  scenario.compass.rate_hz = 10.0;
  std::size_t fixes = 0, readings = 0;
  const auto scans = all_scans(scenario);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i].scan.range_m, without[i].scan.range_m);
    for (const auto& fix : scans[i].gnss) EXPECT_EQ(fix.stamp_ns, scans[i].scan.stamp_ns);
    fixes += scans[i].gnss.size();
    readings += scans[i].compass.size();
  }
  EXPECT_EQ(fixes, 8U);
  EXPECT_EQ(readings, 40U);
}

TEST(Drive, HasAGyroThatTurnsAsTheVehicleDoes) {
  ScenarioConfig scenario = short_drive(1);
  const auto without = all_scans(scenario);
  scenario.imu = {.rate_hz = 100.0,
                  .noise_radps = 0.0,
                  .bias_sigma_radps = 0.0,
                  .bias_walk_radps = 0.0,
                  .scale_sigma = 0.0};
  const auto scans = all_scans(scenario);
  double turned_rad = 0.0;
  std::size_t readings = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i].scan.range_m, without[i].scan.range_m);
    for (const auto& reading : scans[i].turn_rates) {
      EXPECT_LE(reading.stamp_ns, scans[i].scan.stamp_ns);
      if (i > 0) EXPECT_GE(reading.stamp_ns, scans[i - 1].scan.stamp_ns);
      turned_rad += 0.01 * reading.yaw_rate_radps;
    }
    readings += scans[i].turn_rates.size();
  }
  EXPECT_NEAR(static_cast<double>(readings), 400.0, 5.0);
  EXPECT_NEAR(geometry::wrap_angle(turned_rad - scans.back().world_from_base.heading_rad +
                                   scans.front().world_from_base.heading_rad),
              0.0, 0.01);
}

}  // namespace
}  // namespace slammot::simulation
