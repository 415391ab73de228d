#include "services/detection/label_runs.hpp"

#include <numeric>
#include <string_view>

#include <gtest/gtest.h>

namespace slammot::detection {
namespace {

using flow::PointLabel;

PointLabel label_of(char letter) {
  return letter == 'm'   ? PointLabel::kMoving
         : letter == 's' ? PointLabel::kStationary
                         : PointLabel::kUnknown;
}

/// Runs of one segment as text, one letter a beam. `labels`: 's' stationary, 'm' moving, '?'
/// unknown. Stationary points are on a wall along y; moving ones are `in_front_m` in front of it.
/// From beam wall_ends on stationary points are on another wall, 4 m behind.
std::string runs_of(std::string_view labels, double in_front_m = 2.0,
                    std::size_t wall_ends = 1000) {
  flow::SegmentedScan scan;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    scan.labels.push_back(label_of(labels[i]));
    scan.points_in_base_m.emplace_back(
        static_cast<float>(10.0 - (labels[i] == 'm' ? in_front_m : 0.0) +
                           (i < wall_ends ? 0.0 : 4.0)),
        static_cast<float>(0.1 * static_cast<double>(i)));
  }
  std::vector<std::uint16_t> beams(labels.size());
  std::iota(beams.begin(), beams.end(), std::uint16_t{0});
  std::vector<Run> runs;
  split_by_label(beams, scan, runs);
  std::string text;
  for (const Run& run : runs) {
    EXPECT_EQ(run.first, text.size());
    text += std::string(run.count, run.is_moving ? 'm' : 's');
  }
  return text;
}

TEST(LabelRuns, SplitBeamsByTheirLabels) {
  EXPECT_EQ(runs_of("ssssmmmmssss"), "ssssmmmmssss");
  EXPECT_EQ(runs_of("mmmmm"), "mmmmm");
}

TEST(LabelRuns, AssignUnknownBeamsToTheRunBefore) {
  EXPECT_EQ(runs_of("ssss??mmmm??ssss"), "ssssssmmmmmmssss");
  EXPECT_EQ(runs_of("??mmmm"), "mmmmmm") << "at the beginning: to the first run";
  EXPECT_EQ(runs_of("????"), "ssss");
}

TEST(LabelRuns, GiveShortRunsTheLabelOfTheirNeighbours) {
  EXPECT_EQ(runs_of("ssssmssss"), "sssssssss");
  EXPECT_EQ(runs_of("mmmmssmmmm"), "mmmmmmmmmm");
}

TEST(LabelRuns, AreStationaryWhereTheyContinueAWall) {
  EXPECT_EQ(runs_of("ssssmmmmssss", 0.0), "ssssssssssss");
  EXPECT_EQ(runs_of("ssssmmmm", 0.0), "ssssssss");
}

TEST(LabelRuns, CompareAnEndOfASegmentWithTheFourBeamsBesideIt) {
  EXPECT_EQ(runs_of("mmmmssssssss", 0.0, 8), "ssssssssssss") << "the fifth is of another wall";
  EXPECT_EQ(runs_of("mmmmssssssss", 0.0, 7), "mmmmssssssss");
}

}  // namespace
}  // namespace slammot::detection
