#include "services/localization/scan_integration.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using flow::PointLabel;
using geometry::Vector2;

constexpr std::int64_t kPeriod_ns = 50'000'000;

/// Scans of one beam along x, which sees something at 5 m.
class ScanIntegrationTest : public ::testing::Test {
 protected:
  static LocalizerConfig config() {
    LocalizerConfig config;
    config.map.side_m = 40.0;
    return config;
  }

  void remember(std::uint32_t sequence, MapAdmission admission = MapAdmission::kMapped,
                float range_m = 5.0F) {
    sensing::LaserScan scan;
    scan.stamp_ns = sequence * kPeriod_ns;
    scan.sequence = sequence;
    scan.scanner.scanner_id = scanner_id_;
    scan.scanner.max_range_m = 30.0;
    scan.range_m = {range_m};
    flow::LocalizedScan localized;
    localized.beams.resize(1);
    if (range_m > 0.0F) localized.beams.front().end_cell = end_cell_;
    integration_.remember(
        {scan, localized, {Vector2(range_m, 0.0)}, {Vector2(1.0, 0.0)}, companion_beams_},
        admission, map_);
  }

  static flow::ScanLabels labels(std::uint32_t sequence,
                                 PointLabel label = PointLabel::kStationary) {
    return {sequence * kPeriod_ns, sequence, "front", {label}, {}};
  }

  IntegrationCounts integrate(const flow::ScanLabels& labels,
                              PoseTrust trust = PoseTrust::kConfirmed) {
    return integration_.integrate(labels, trust, map_);
  }
  std::size_t surfels() const { return map_.surfels().all().size(); }
  bool saw_moving() const {
    return map_.evidence().moving(map_.evidence().window().cell_at(5.0, 0.0)) > 0;
  }

  std::string scanner_id_ = "front";
  std::vector<std::size_t> companion_beams_;
  flow::EndCell end_cell_ = flow::EndCell::kUnseen;
  LocalMap map_{config().map, Vector2::Zero()};
  ScanIntegration integration_{config()};
};

TEST_F(ScanIntegrationTest, MapsByLabels) {
  remember(1);
  EXPECT_TRUE(integration_.awaits_labels());
  integrate(labels(1));
  EXPECT_EQ(surfels(), 1U);
  EXPECT_FALSE(integration_.awaits_labels());
  EXPECT_EQ(integration_.integrated_scans(), 1U);
}

TEST_F(ScanIntegrationTest, KeepsWhatMovesOutOfTheSoMap) {
  remember(1);
  integrate(labels(1, PointLabel::kMoving));
  EXPECT_EQ(surfels(), 0U);
  EXPECT_TRUE(saw_moving());
}

TEST_F(ScanIntegrationTest, KeepsWhatGoesAlongWithTheVehicleOutOfTheMap) {
  companion_beams_ = {0};
  remember(1);
  integrate(labels(1));
  EXPECT_EQ(surfels(), 0U);
  EXPECT_FALSE(saw_moving());
  integrate({2 * kPeriod_ns, 2, "front", {PointLabel::kStationary}, {{1, {0}}}});
  EXPECT_EQ(surfels(), 0U) << "nor does tracking give it back";
}

TEST_F(ScanIntegrationTest, IgnoresLabelsOfAnUnknownScan) {
  remember(1);
  integrate(labels(2));
  EXPECT_FALSE(integration_.awaits(labels(2)));
  EXPECT_TRUE(integration_.awaits(labels(1)));
  EXPECT_EQ(surfels(), 0U);
}

TEST_F(ScanIntegrationTest, MapsInOrderAndWithoutLabelsWhatWaitsBefore) {
  remember(1);
  remember(2);
  EXPECT_EQ(integrate(labels(2)).fallback_integrations, 1U);
  EXPECT_EQ(integration_.integrated_scans(), 2U);
}

TEST_F(ScanIntegrationTest, TakesLabelsOfDetectionWhereThoseOfTrackingAreOverdue) {
  remember(1);
  flow::SegmentedScan segmented;
  segmented.sequence = 1;
  segmented.scanner_id = "front";
  segmented.labels = {PointLabel::kMoving};
  integration_.note(segmented);
  EXPECT_EQ(integration_.integrate_overdue(2 * kPeriod_ns, PoseTrust::kConfirmed, map_)
                .fallback_integrations,
            0U);
  EXPECT_EQ(integration_.integrate_overdue(6 * kPeriod_ns, PoseTrust::kConfirmed, map_)
                .fallback_integrations,
            1U);
  EXPECT_TRUE(saw_moving());
}

TEST_F(ScanIntegrationTest, WaitsLongerForLabelsThatCameUntilNow) {
  remember(1);
  integrate(labels(1));
  for (std::uint32_t sequence = 2; sequence < 8; ++sequence) remember(sequence);
  EXPECT_EQ(integration_.integrate_overdue(8 * kPeriod_ns, PoseTrust::kConfirmed, map_)
                .fallback_integrations,
            0U)
      << "tracking may be being restarted";
  EXPECT_EQ(integrate(labels(2)).fallback_integrations, 0U);
  integration_.integrate_overdue(100 * kPeriod_ns, PoseTrust::kConfirmed, map_);
  EXPECT_FALSE(integration_.awaits_labels());
  for (std::uint32_t sequence = 101; sequence < 105; ++sequence) remember(sequence);
  EXPECT_EQ(integration_.integrate_overdue(105 * kPeriod_ns, PoseTrust::kConfirmed, map_)
                .fallback_integrations,
            2U)
      << "it does not come back: what waits for 0.15 s";
}

TEST_F(ScanIntegrationTest, LeavesOutWhatContradictsTheMapWhereThereAreNoLabels) {
  end_cell_ = flow::EndCell::kFree;
  remember(1);
  integration_.integrate_all(PoseTrust::kConfirmed, map_);
  EXPECT_EQ(surfels(), 0U);
  EXPECT_EQ(integration_.integrated_scans(), 1U);
}

TEST_F(ScanIntegrationTest, NeverMapsAWithheldScan) {
  remember(1, MapAdmission::kWithheld);
  EXPECT_EQ(integrate(labels(1)).withheld_scans, 1U);
  EXPECT_EQ(integration_.integrated_scans(), 0U);
}

TEST_F(ScanIntegrationTest, MapsADoubtedScanOnceThePoseIsConfirmedOrNever) {
  for (const bool is_confirmed : {true, false}) {
    remember(1, MapAdmission::kDoubted);
    const std::uint64_t before = integration_.integrated_scans();
    integrate(labels(1), PoseTrust::kDoubted);
    EXPECT_EQ(integration_.integrated_scans(), before);
    if (!is_confirmed) EXPECT_EQ(integration_.drop_doubted().withheld_scans, 1U);
    integration_.integrate_doubted(map_);
    EXPECT_EQ(integration_.integrated_scans(), before + (is_confirmed ? 1 : 0));
  }
}

TEST_F(ScanIntegrationTest, GivesBackRestoredPoints) {
  remember(1);
  integrate(labels(1, PointLabel::kMoving));
  remember(2);
  flow::ScanLabels with_restored = labels(2, PointLabel::kMoving);
  with_restored.restored = {{1, {0}}};
  EXPECT_EQ(integrate(with_restored).restored_points, 1U);
  EXPECT_EQ(surfels(), 1U);
}

TEST_F(ScanIntegrationTest, GivesBackPointsOfTheScannerThatSawThem) {
  scanner_id_ = "rear";
  remember(1);
  flow::ScanLabels of_rear = labels(1, PointLabel::kMoving);
  of_rear.scanner_id = "rear";
  integrate(of_rear);
  scanner_id_ = "front";
  remember(2);
  flow::ScanLabels with_restored = labels(2, PointLabel::kMoving);
  with_restored.restored = {{1, {0}}};  // of a scan that this scanner never made
  EXPECT_EQ(integrate(with_restored).restored_points, 0U);
  EXPECT_EQ(surfels(), 0U);
}

TEST_F(ScanIntegrationTest, RemembersForRestoringWhatIsSomeSecondsOldAndNoMore) {
  const auto restored_after = [this](std::uint32_t scans) {
    integration_ = ScanIntegration(config());
    for (std::uint32_t sequence = 1; sequence <= scans; ++sequence) {
      remember(sequence);
      integrate(labels(sequence, PointLabel::kMoving));
    }
    remember(scans + 1);
    flow::ScanLabels with_restored = labels(scans + 1, PointLabel::kMoving);
    with_restored.restored = {{1, {0}}};
    return integrate(with_restored).restored_points;
  };
  EXPECT_EQ(restored_after(60), 1U);
  EXPECT_EQ(restored_after(120), 0U);
}

TEST_F(ScanIntegrationTest, FreesNothingByAnEchoThatIsTooNear) {
  remember(1, MapAdmission::kMapped, 0.1F);
  end_cell_ = flow::EndCell::kNoEcho;
  remember(2, MapAdmission::kMapped, 0.1F);
  integration_.forget_last();
  integrate(labels(1));
  EXPECT_EQ(map_.evidence().so_steps(map_.evidence().window().cell_at(2.0, 0.0)), 0);
}

/// Before a wall 5 m ahead, of which the beams that is_lost tells have no echo, and a post some
/// metres away.
class WallWithDropOuts : public ScanIntegrationTest {
 protected:
  static constexpr int kBeams = 60;
  static constexpr int kBeamsOnPost = 3;
  static Vector2 direction(int beam) {
    const double angle_rad = 0.01 * (beam - kBeams / 2);
    return {std::cos(angle_rad), std::sin(angle_rad)};
  }

  template <typename IsLost>
  void map_wall(IsLost is_lost) {
    sensing::LaserScan scan;
    scan.scanner.scanner_id = "front";
    scan.scanner.max_range_m = 30.0;
    scan.scanner.beam_step_rad = 0.01;
    flow::LocalizedScan localized;
    std::vector<Vector2> points_m;
    std::vector<Vector2> beams;
    for (int i = 0; i < kBeams; ++i) {
      const auto range_m = static_cast<float>(i < kBeamsOnPost ? post_m_ : 5.0 / direction(i).x());
      beams.push_back(direction(i));
      points_m.push_back(range_m * beams.back());
      const bool has_echo = i < kBeamsOnPost || !is_lost(i);
      scan.range_m.push_back(has_echo ? range_m : 30.0F);
      localized.beams.emplace_back().end_cell =
          has_echo ? flow::EndCell::kUnseen : flow::EndCell::kNoEcho;
    }
    integration_.remember({scan, localized, points_m, beams, {}}, MapAdmission::kMapped, map_);
    integrate({0, 0, "front", std::vector<PointLabel>(kBeams, PointLabel::kStationary), {}});
  }

  static bool is_at_gap(int beam) { return beam >= 20 && beam < 40; }

  bool is_free_behind_wall(int beam) const {
    const Vector2 at_m = 8.0 * direction(beam);
    return map_.evidence().so_steps(map_.evidence().window().cell_at(at_m.x(), at_m.y())) < 0;
  }

  double post_m_ = 12.0;
};

TEST_F(WallWithDropOuts, IsNotSeenThroughByThem) {
  const auto every_third = [](int beam) { return beam % 3 == 1; };
  map_wall(every_third);
  for (int i = kBeamsOnPost; i < kBeams; ++i) EXPECT_FALSE(is_free_behind_wall(i)) << "beam " << i;
}

TEST_F(WallWithDropOuts, IsSeenThroughWhereItHasAGap) {
  map_wall([](int beam) { return is_at_gap(beam) || beam % 3 == 1; });
  EXPECT_TRUE(is_free_behind_wall(30));
}

TEST_F(WallWithDropOuts, IsSeenThroughNoFartherThanAnythingHasAnswered) {
  post_m_ = 6.0;
  map_wall(is_at_gap);
  EXPECT_FALSE(is_free_behind_wall(30)) << "the scanner may see 7 m and no more";
  post_m_ = 9.0;
  map_wall(is_at_gap);
  EXPECT_TRUE(is_free_behind_wall(30));
}

}  // namespace
}  // namespace slammot::localization
