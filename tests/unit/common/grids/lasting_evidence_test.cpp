#include "common/grids/lasting_evidence.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace slammot::grids {
namespace {

constexpr double kCell_m = 0.2;
const LastingModel kModel;
const int kHit = steps_of_log_odds(kModel.echo_log_odds);
const int kFree = kHit;
const int kLimit = steps_of_log_odds(kModel.limit_log_odds);
const Box kBody{{0.0, 0.0}, {1.0, 0.0}, {2.1, 0.9}};

class Lasting : public ::testing::Test {
 protected:
  int steps_at(const Eigen::Vector2d& at_m) const {
    return evidence_.cells()[window_.index(cell_at(at_m))];
  }
  Cell cell_at(const Eigen::Vector2d& at_m) const { return window_.cell_at(at_m.x(), at_m.y()); }
  void hit(const Eigen::Vector2d& at_m, int scans) {
    for (int i = 0; i < scans; ++i) evidence_.hit(cell_at(at_m));
  }
  void pass(const Eigen::Vector2d& at_m, int scans) {
    for (int i = 0; i < scans; ++i) {
      const Cell cell = cell_at(at_m);
      passed_.set(cell.column - window_.first.column, cell.row - window_.first.row);
      evidence_.pass(passed_);
    }
  }
  void drive_over(int scans) {
    for (int i = 0; i < scans; ++i) evidence_.drive_over(kBody);
  }

  GridWindow window_ = window_around({0.0, 0.0}, 20.0, kCell_m);
  LastingEvidence evidence_{window_, kModel};
  BitRows passed_{window_.columns, window_.rows};
};

TEST_F(Lasting, TakesABeamForAsMuchAsAnEcho) {
  hit({3.1, 0.1}, 5);
  EXPECT_EQ(steps_at({3.1, 0.1}), 5 * kHit);
  pass({3.1, 0.1}, 5);
  EXPECT_EQ(steps_at({3.1, 0.1}), 0);
  EXPECT_TRUE(std::ranges::all_of(passed_.words, [](std::uint64_t word) { return word == 0; }));
}

TEST_F(Lasting, IsNeverSurerThanItsLimit) {
  hit({3.1, 0.1}, 300);
  pass({-9.9, 9.9}, 300);
  EXPECT_EQ(steps_at({3.1, 0.1}), kLimit);
  EXPECT_EQ(steps_at({-9.9, 9.9}), -kLimit);
}

TEST_F(Lasting, LosesAgainWhatItGainedAfterItWasAsLowAsItGets) {
  for (int time = 0; time < 2; ++time) {
    pass({3.1, 0.1}, 300);
    hit({3.1, 0.1}, 3);
    EXPECT_EQ(steps_at({3.1, 0.1}), 3 * kHit - kLimit);
    pass({3.1, 0.1}, 1);
    EXPECT_EQ(steps_at({3.1, 0.1}), 3 * kHit - kLimit - kFree);
  }
  evidence_.set_cells(std::vector<std::int8_t>(window_.cell_count(), 0));
  pass({3.1, 0.1}, 1);
  EXPECT_EQ(steps_at({3.1, 0.1}), -kFree);
}

TEST_F(Lasting, KeepsForGoodWhatWasDrivenOver) {
  drive_over(25);
  EXPECT_TRUE(LastingEvidence::is_driven_over(static_cast<std::int8_t>(steps_at({0.1, 0.1}))));
  hit({0.1, 0.1}, 300);
  pass({0.1, 0.1}, 300);
  EXPECT_TRUE(LastingEvidence::is_driven_over(static_cast<std::int8_t>(steps_at({0.1, 0.1}))));
}

TEST_F(Lasting, BelievesNoFewScansOfABody) {
  drive_over(10);
  hit({0.1, 0.1}, 13);
  EXPECT_GT(steps_at({0.1, 0.1}), 0);
}

TEST_F(Lasting, TakesFromTheSidesOfABodyWhatIsOccupiedThereAndNoMore) {
  hit({2.05, 0.1}, 3);
  drive_over(30);
  EXPECT_EQ(steps_at({2.05, 0.1}), 0);  // of its front
  EXPECT_EQ(steps_at({0.1, 0.85}), 0);  // beside which something may stand
  EXPECT_EQ(steps_at({2.5, 0.1}), 0);
  EXPECT_LT(steps_at({1.5, 0.1}), -kLimit);
}

TEST_F(Lasting, KnowsNoBodiesElsewhere) {
  for (const Box& elsewhere :
       {Box{{1e6, 0.0}, {1.0, 0.0}, {2.0, 1.0}}, Box{{0.0, -1e6}, {0.0, 1.0}, {2.0, 1.0}}})
    evidence_.drive_over(elsewhere);
  EXPECT_TRUE(std::ranges::all_of(evidence_.cells(), [](std::int8_t steps) { return steps == 0; }));
  evidence_.drive_over({{9.9, 9.9}, {0.6, 0.8}, {3.0, 1.0}});  // partly outside
  EXPECT_EQ(steps_at({9.9, 9.9}), -kFree);
}

}  // namespace
}  // namespace slammot::grids
