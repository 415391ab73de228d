#include "services/tracking/workspace.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/help_at_the_last_moment.hpp"

namespace slammot::tracking {
namespace {

using ::testing::ElementsAre;

std::vector<flow::RestoredPoints> points_of(std::size_t scans) {
  std::vector<flow::RestoredPoints> points(scans);
  for (std::size_t i = 0; i < scans; ++i)
    points[i] = {static_cast<std::uint32_t>(i), std::vector<std::uint16_t>(100, 1)};
  return points;
}

TEST(Workspace, GivesBackTheMemoryOfWhatWasRemoved) {
  Workspace workspace(nullptr);
  std::vector<flow::RestoredPoints> points = points_of(2);
  const std::uint16_t* memory = points[1].beams.data();
  workspace.resize(points, 1);
  EXPECT_EQ(points.size(), 1U);
  workspace.resize(points, 2);
  EXPECT_EQ(points[1].beams.data(), memory);
}

TEST(Workspace, RemovesWithoutChangingTheOrderOfTheOthers) {
  Workspace workspace(nullptr);
  std::vector<flow::RestoredPoints> points = points_of(5);
  workspace.remove_if(points,
                      [](const flow::RestoredPoints& one) { return one.sequence % 2 == 1; });
  std::vector<std::uint32_t> left;
  for (const flow::RestoredPoints& one : points) left.push_back(one.sequence);
  EXPECT_THAT(left, ElementsAre(0U, 2U, 4U));
}

TEST(Workspace, DoesEachPartOnceWithHelpAndWithout) {
  testing::HelpAtTheLastMoment help;
  for (work::SideWork* helper :
       {static_cast<work::SideWork*>(nullptr), static_cast<work::SideWork*>(&help)}) {
    const Workspace workspace(helper);
    std::vector<int> done(10, 0);
    workspace.for_each(done.size(), [&](std::size_t i) { ++done[i]; });
    workspace.for_each_in_ranges(done.size(), [&](std::size_t i) { ++done[i]; });
    EXPECT_THAT(done, ::testing::Each(2));
  }
  EXPECT_EQ(help.shared(), 2);
}

}  // namespace
}  // namespace slammot::tracking
