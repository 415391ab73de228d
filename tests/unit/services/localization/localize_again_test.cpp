// Iterated SLAM with DATMO: a scan that is matched again once it is known what moves in it.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/localization/localizer.hpp"
#include "tests/support/localizer_drive.hpp"

namespace slammot::localization {
namespace {

using flow::PointLabel;
using slammot::testing::all_stationary;
using slammot::testing::arc;
using slammot::testing::distance_m;
using slammot::testing::drive_through;
using slammot::testing::DriveSetup;
using slammot::testing::SimulatedDrive;
using slammot::testing::small_map_config;

constexpr std::uint32_t kMoves = 20;  // the scan in which it is seen to move,
constexpr double kFront_m = 2.87;     // and how far before the scanner its front is then
constexpr double kMiddle_m = 1.494;   // to each side: what beams of 27.5 degrees would meet, and no
                                      // beam does

/// Something as wide as the room, right before the scanner, that nobody predicts to move until it
/// does: half of all echoes.
class LocalizeAgain : public ::testing::Test {
 protected:
  LocalizeAgain() : before_(in_room_with_block_at(0.0)), moved_(in_room_with_block_at(0.12)) {
    reach_the_scan(localizer_);
  }

  static DriveSetup in_room_with_block_at(double x_m) {
    DriveSetup setup{.world = slammot::testing::room(),
                     .world_from_base_at = arc({-3.0, 0.0, 0.0}, 0.0, 0.0)};
    setup.world = joined(setup.world, slammot::testing::box({x_m, 0.0, 0.0}, 0.5, 8.0));
    return setup;
  }

  static LocalizerConfig config() {
    LocalizerConfig config = small_map_config();
    config.trust.ambiguous.weak_share = 0.0;  // samples disagree about such a scan and keep it from
                                              // pulling anyway,
    config.odometry.use_odometry = false;     // and so do wheels, most of all where they stand
    return config;
  }

  void reach_the_scan(Localizer& localizer) {
    SimulatedDrive drive = before_;
    drive_through(localizer, drive, 0, kMoves);
    localizer.add_odometry(drive.odometry(kMoves));
  }

  sensing::LaserScan scan() const { return moved_.scan(kMoves); }

  /// The block moves, as far as it is seen to half_width_m to each side.
  static flow::ScanLabels labels_of(const flow::LocalizedScan& scan, double half_width_m = 8.0) {
    flow::ScanLabels labels = all_stationary(scan);
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      const Eigen::Vector2f& at_m = scan.beams[i].point_in_base_m;
      const bool is_on_front = std::abs(at_m.x() - kFront_m) < ExpectedObjects::kMaskMarginM &&
                               std::abs(at_m.y()) < half_width_m;
      if (is_on_front && scan.beams[i].range_m > 0.0F) labels.labels[i] = PointLabel::kMoving;
    }
    return labels;
  }

  double error_m(const flow::LocalizedScan& scan) const {
    return distance_m(scan.odom_from_base.pose, moved_.odom_from_base(kMoves));
  }

  /// What tracking says of the middle of the block's front if it knew of it in time.
  flow::TrackedObjects expected_block() const {
    flow::TrackedObject block;
    block.confirmed = true;
    block.position_in_odom_m = {kFront_m, 0.0};
    block.length_m = 0.0;
    block.width_m = 2.0 * (kMiddle_m - ExpectedObjects::kMaskMarginM);
    flow::TrackedObjects objects;
    objects.stamp_ns = scan().stamp_ns;
    objects.objects = {block};
    return objects;
  }

  SimulatedDrive before_;
  SimulatedDrive moved_;
  Localizer localizer_{config()};
};

TEST_F(LocalizeAgain, IsNotPulledAlongByWhatTurnedOutToMove) {
  const auto first = localizer_.localize(scan());
  const auto labels = labels_of(*first).labels;
  ASSERT_GT(std::count(labels.begin(), labels.end(), PointLabel::kMoving), 60);
  const auto again = localizer_.localize_again(scan(), labels);
  ASSERT_TRUE(again);
  EXPECT_LT(error_m(*again), 0.01);
  EXPECT_GT(error_m(*first), 2.0 * error_m(*again));
  EXPECT_EQ(again->sequence, first->sequence);
  EXPECT_EQ(again->beams.size(), first->beams.size());
}

TEST_F(LocalizeAgain, ComesToTheBitsThatItWouldHaveComeToHadItKnownAtOnce) {
  Localizer knew(config());
  reach_the_scan(knew);
  knew.expect(expected_block());
  const auto at_once = knew.localize(scan());
  const auto first = localizer_.localize(scan());
  const auto again = localizer_.localize_again(scan(), labels_of(*first, kMiddle_m).labels);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->odom_from_base.pose, at_once->odom_from_base.pose);
  EXPECT_EQ(again->odom_from_base.covariance, at_once->odom_from_base.covariance);
  knew.integrate(labels_of(*at_once));
  localizer_.integrate(labels_of(*again));
  EXPECT_EQ(localizer_.checkpoint(), knew.checkpoint());  // estimate, variances, travelled way,
                                                          // counters and map
}

TEST_F(LocalizeAgain, PutsTheScanIntoTheMapOnce) {
  const auto first = localizer_.localize(scan());
  const auto again = localizer_.localize_again(scan(), labels_of(*first).labels);
  ASSERT_TRUE(again);
  localizer_.integrate(labels_of(*again));
  EXPECT_FALSE(localizer_.awaits_labels());
  const auto integrated = localizer_.checkpoint();
  localizer_.integrate(labels_of(*first));
  EXPECT_EQ(localizer_.checkpoint(), integrated);
  EXPECT_EQ(localizer_.counters().scans.localized, kMoves + 1);
  EXPECT_EQ(localizer_.counters().map.fallback_integrations, 0U);
}

TEST_F(LocalizeAgain, ChangesNothingWhereNoMorePointsAreLeftOut) {
  const auto first = localizer_.localize(scan());
  const auto before = localizer_.checkpoint();
  EXPECT_FALSE(localizer_.localize_again(scan(), all_stationary(*first).labels));
  EXPECT_EQ(localizer_.checkpoint(), before);
  const auto labels = labels_of(*first).labels;
  EXPECT_TRUE(localizer_.localize_again(scan(), labels));
  const auto converged = localizer_.checkpoint();
  EXPECT_FALSE(localizer_.localize_again(scan(), labels));
  EXPECT_EQ(localizer_.checkpoint(), converged);
}

TEST_F(LocalizeAgain, ChangesNothingWhereTracksHadItLeftOutAlready) {
  localizer_.expect(expected_block());
  const auto first = localizer_.localize(scan());
  EXPECT_FALSE(localizer_.localize_again(scan(), labels_of(*first, kMiddle_m).labels));
}

TEST_F(LocalizeAgain, KeepsTheMatchOfAllPointsWhereTooFewAreLeft) {
  const auto first = localizer_.localize(scan());
  const auto before = localizer_.checkpoint();
  const std::vector<PointLabel> everything(first->beams.size(), PointLabel::kMoving);
  EXPECT_FALSE(localizer_.localize_again(scan(), everything));
  EXPECT_EQ(localizer_.checkpoint(), before);
  localizer_.integrate(labels_of(*first));
  EXPECT_FALSE(localizer_.awaits_labels());
}

TEST_F(LocalizeAgain, IsOnlyForTheLastScanAndBeforeItIsInTheMap) {
  const auto first = localizer_.localize(scan());
  const auto labels = labels_of(*first);
  EXPECT_FALSE(localizer_.localize_again(moved_.scan(kMoves + 1), labels.labels));
  EXPECT_FALSE(localizer_.localize_again(scan(), {}));
  localizer_.integrate(labels);
  EXPECT_FALSE(localizer_.localize_again(scan(), labels.labels));
  ASSERT_TRUE(localizer_.localize(moved_.scan(kMoves + 1)));
  EXPECT_FALSE(localizer_.localize_again(scan(), labels.labels));
}

TEST_F(LocalizeAgain, IsNotForTheFirstScanByWhichTheMapBegins) {
  Localizer fresh(config());
  const auto first = fresh.localize(scan());
  EXPECT_FALSE(fresh.localize_again(scan(), labels_of(*first).labels));
}

TEST_F(LocalizeAgain, IsNotForAVehicleThatDoesNotKnowWhereItIs) {
  DriveSetup elsewhere = moved_.setup();
  elsewhere.world = slammot::testing::box({0.0, 0.0, 0.7}, 40.0, 31.0);
  const sensing::LaserScan strange = SimulatedDrive(elsewhere).scan(kMoves);
  const auto first = localizer_.localize(strange);
  ASSERT_EQ(localizer_.counters().matches.lost, 1U);
  EXPECT_FALSE(localizer_.localize_again(strange, labels_of(*first).labels));
  flow::ScanLabels some_move = all_stationary(*first);
  for (std::size_t i = 0; i < 60; ++i) some_move.labels[i] = PointLabel::kMoving;
  EXPECT_FALSE(localizer_.localize_again(strange, some_move.labels));
}

TEST_F(LocalizeAgain, IsOffWhereMovingThingsAreMatchedOnPurpose) {
  LocalizerConfig all = config();
  all.echoes.leave_out_moving = false;
  Localizer believes_all(all);
  reach_the_scan(believes_all);
  const auto first = believes_all.localize(scan());
  EXPECT_FALSE(believes_all.localize_again(scan(), labels_of(*first).labels));
}

TEST_F(LocalizeAgain, StillTakesAnotherScannersScanOfTheSameTimeAndDropsDuplicates) {
  const auto first = localizer_.localize(scan());
  ASSERT_TRUE(localizer_.localize_again(scan(), labels_of(*first).labels));
  EXPECT_FALSE(localizer_.localize(scan()));
  sensing::LaserScan of_another = scan();
  of_another.scanner.scanner_id = "rear";
  const auto second = localizer_.localize(of_another);
  ASSERT_TRUE(second);
  EXPECT_TRUE(localizer_.localize_again(of_another, labels_of(*second).labels));
  EXPECT_FALSE(localizer_.localize(of_another));
  EXPECT_EQ(localizer_.counters().scans.duplicate, 2U);
}

}  // namespace
}  // namespace slammot::localization
