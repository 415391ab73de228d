#include "services/localization/deferred_evidence.hpp"

#include <utility>

#include <gtest/gtest.h>

#include "services/localization/localizer.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/help_at_the_last_moment.hpp"
#include "tests/support/localizer_drive.hpp"

namespace slammot::localization {
namespace {

using geometry::Vector2;
using slammot::testing::HelpAtTheLastMoment;

grids::EvidenceGrid empty_grid() {
  return {grids::window_around(Vector2::Zero(), 20.0, 0.2), grids::EvidenceModel{}};
}

std::vector<grids::Ray> echoes_at(double x_m) {
  return {{{x_m, 0.1}, grids::Echo::kStationary},
          {{x_m, 0.5}, grids::Echo::kMoving},
          {{0.1, 5.0}, grids::Echo::kNone}};
}

void expect_same(const DeferredEvidence& a, const DeferredEvidence& b) {
  EXPECT_EQ(a.grid().so_cells(), b.grid().so_cells());
  EXPECT_EQ(a.grid().mo_cells(), b.grid().mo_cells());
  EXPECT_EQ(a.grid().lasting_cells(), b.grid().lasting_cells());
}

TEST(DeferredEvidence, LeavesTheScanToItsHelpUntilTheGridIsAskedFor) {
  HelpAtTheLastMoment help;
  DeferredEvidence evidence(empty_grid(), &help);
  evidence.integrate({0.1, 0.1}, echoes_at(3.1), 0.0);
  EXPECT_TRUE(help.is_at_work());
  EXPECT_GT(std::as_const(evidence).grid().so_steps(empty_grid().window().cell_at(3.1, 0.1)), 0);
  EXPECT_FALSE(help.is_at_work());
}

TEST(DeferredEvidence, HoldsTheSameWithHelpAndWithout) {
  HelpAtTheLastMoment help;
  DeferredEvidence helped(empty_grid(), &help);
  DeferredEvidence alone(empty_grid(), nullptr);
  for (DeferredEvidence* evidence : {&helped, &alone}) {
    for (int scan = 0; scan < 20; ++scan) {
      std::vector<grids::Ray> rays = echoes_at(3.1 + 0.2 * (scan % 5));
      evidence->integrate({0.1, 0.1}, rays, 0.0);
      rays.clear();  // what was handed over is the caller's again
      if (scan % 3 == 0)
        evidence->restore_stationary({3.1, 0.1});  // through which the last scan may have seen: the
                                                   // order tells
      if (scan % 4 == 0) evidence->drive_over({{3.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}});
    }
  }
  expect_same(helped, alone);
}

TEST(DeferredEvidence, HoldsTheSameWhereHelpPreparesAScan) {
  HelpAtTheLastMoment help;
  DeferredEvidence helped(empty_grid(), &help);
  DeferredEvidence alone(empty_grid(), nullptr);
  for (DeferredEvidence* evidence : {&helped, &alone}) {
    for (int scan = 0; scan < 20; ++scan) {
      std::vector<grids::Ray> rays = echoes_at(3.1 + 0.2 * (scan % 5));
      evidence->prepare({0.1, 0.1}, rays, 0.0);
      if (scan % 4 == 0) rays.front().echo = grids::Echo::kMoving;
      if (scan % 7 == 0) rays.front().echo = grids::Echo::kNone;
      evidence->integrate({0.1, 0.1}, rays, 0.0);
      if (scan % 3 == 0) evidence->restore_stationary({3.1, 0.1});
    }
  }
  expect_same(helped, alone);
  EXPECT_EQ(help.begun(), 40);
}

TEST(DeferredEvidence, MayMoveWhileItsHelpIsAtWork) {
  HelpAtTheLastMoment help;
  DeferredEvidence alone(empty_grid(), nullptr);
  alone.integrate({0.1, 0.1}, echoes_at(3.1), 0.0);
  DeferredEvidence first(empty_grid(), &help);
  first.integrate({0.1, 0.1}, echoes_at(3.1), 0.0);
  DeferredEvidence second = std::move(first);
  EXPECT_TRUE(help.is_at_work());
  expect_same(second, alone);
}

TEST(DeferredEvidence, DoesNotGoBeforeItsHelpIsDone) {
  HelpAtTheLastMoment help;
  { DeferredEvidence(empty_grid(), &help).integrate({0.1, 0.1}, echoes_at(3.1), 0.0); }
  EXPECT_FALSE(help.is_at_work());
}

TEST(DeferredEvidence, ChangesNothingThatLeavesTheLocalizer) {
  slammot::testing::DriveSetup street{
      .world = slammot::testing::street(80.0),
      .world_from_base_at = slammot::testing::arc({2.0, -1.0, 0.02}, 8.0, 0.0)};
  street.scan_period_s = 0.05;
  LocalizerConfig config = slammot::testing::small_map_config();
  config.echoes.expects_all_ranges = true;
  config.map.side_m = 60.0;
  config.map.new_map_after_m = 15.0;
  slammot::testing::SimulatedDrive drive(street);
  slammot::testing::SimulatedDrive same_drive(street);
  HelpAtTheLastMoment help;
  Localizer helped(config, &help);
  Localizer alone(config);
  int submaps = 0;
  for (std::uint32_t scan = 0; scan < 120; ++scan) {
    const auto of_helped = drive_one(helped, drive, scan);
    const auto of_alone = drive_one(alone, same_drive, scan);
    ASSERT_EQ(of_helped->odom_from_base.pose, of_alone->odom_from_base.pose) << scan;
    for (std::size_t i = 0; i < of_alone->beams.size(); ++i) {
      ASSERT_EQ(of_helped->beams[i].expected_range_m, of_alone->beams[i].expected_range_m);
      ASSERT_EQ(of_helped->beams[i].free_evidence, of_alone->beams[i].free_evidence);
      ASSERT_EQ(of_helped->beams[i].end_cell, of_alone->beams[i].end_cell);
    }
    const auto submap_of_helped = helped.take_finished_submap();
    const auto submap_of_alone = alone.take_finished_submap();
    ASSERT_EQ(submap_of_helped.has_value(), submap_of_alone.has_value());
    if (submap_of_alone)
      ASSERT_TRUE(slammot::testing::same_submap(*submap_of_helped, *submap_of_alone));
    submaps += submap_of_alone.has_value();
    if (scan % 17 == 0) ASSERT_EQ(helped.checkpoint(), alone.checkpoint());
  }
  EXPECT_GT(submaps, 0);
  EXPECT_GE(help.begun(), 120);
}

TEST(DeferredEvidence, IsLentTheSameHelpAfterARestore) {
  slammot::testing::DriveSetup street{
      .world = slammot::testing::street(80.0),
      .world_from_base_at = slammot::testing::arc({2.0, -1.0, 0.02}, 8.0, 0.0)};
  slammot::testing::SimulatedDrive drive(street);
  Localizer before(slammot::testing::small_map_config());
  drive_through(before, drive, 0, 10);
  HelpAtTheLastMoment help;
  Localizer after(slammot::testing::small_map_config(), &help);
  ASSERT_TRUE(after.restore(before.checkpoint()));
  drive_one(after, drive, 10);
  EXPECT_TRUE(help.is_at_work());
}

}  // namespace
}  // namespace slammot::localization
