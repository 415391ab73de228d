#include "common/matching/timing_window.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace slammot::matching {
namespace {

constexpr double kTurnSigma_rad = 0.004;
constexpr double kWaySigma_m = 0.02;

/// Heading of a vehicle that weaves, and its way, which it drives now faster, now slower.
double heading_at(double time_s) { return 0.5 * std::sin(0.8 * time_s); }
double way_at(double time_s) { return 3.0 * time_s + 2.0 * std::sin(0.7 * time_s); }

double quantity_at(double time_s, MotionChange change) {
  return is_of_turn(change) ? heading_at(time_s) : way_at(time_s);
}

/// What scans say of a pair that begins at a time, and odometry that is so late and counts so many
/// times too much.
TimedQuantity measured(double from_s, MotionChange change, double late_s, double factor,
                       std::mt19937& random) {
  constexpr double kLong_s = 0.8;
  const auto between = [&](double first_s) {
    return quantity_at(first_s + kLong_s, change) - quantity_at(first_s, change);
  };
  TimedQuantity quantity;
  quantity.change = change;
  quantity.sigma = is_of_turn(change) ? kTurnSigma_rad : kWaySigma_m;
  quantity.by_scans =
      between(from_s) + std::normal_distribution<double>(0.0, quantity.sigma)(random);
  for (std::size_t i = 0; i < TimingDelays::kCount; ++i)
    quantity.by_odometry[i] =
        static_cast<float>(factor * between(from_s + TimingDelays::at(i) - late_s));
  return quantity;
}

void drive(double from_s, int pairs, double late_s, double factor, TimingWindow& window) {
  std::mt19937 random(static_cast<std::uint32_t>(pairs));
  for (int i = 0; i < pairs; ++i) {
    const double time_s = from_s + 0.9 * i;
    const bool turns_more = std::abs(heading_at(time_s + 0.8) - heading_at(time_s + 0.6)) >
                            std::abs(heading_at(time_s + 0.2) - heading_at(time_s));
    const bool is_faster =
        way_at(time_s + 0.8) - way_at(time_s + 0.6) > way_at(time_s + 0.2) - way_at(time_s);
    for (const MotionChange change :
         {turns_more ? MotionChange::kTurnsMore : MotionChange::kTurnsLess,
          is_faster ? MotionChange::kFaster : MotionChange::kSlower})
      window.add(measured(time_s, change, late_s, factor, random));
  }
}

TEST(TimingWindow, TellsTheLatenessToSomeMilliseconds) {
  for (const double late_s : {-0.3, -0.05, 0.0, 0.02, 0.1, 0.3}) {
    TimingWindow window;
    drive(0.0, 20, late_s, 1.0, window);
    const auto found = window.evidence();
    ASSERT_TRUE(found) << late_s;
    EXPECT_NEAR(found->timing.late_s, late_s, 0.008);
    EXPECT_NEAR(found->timing.late_s, late_s, 4.0 * found->timing.sigma_s);
    EXPECT_LT(found->gain_over(late_s), 12.0);
    if (std::abs(late_s) > 0.04) EXPECT_GT(found->gain_over(0.0), 25.0) << late_s;
  }
}

TEST(TimingWindow, DoesNotTakeWheelsThatCountTooMuchForLateOnes) {
  TimingWindow window;
  drive(0.0, 20, 0.0, 1.08, window);
  const auto found = window.evidence();
  ASSERT_TRUE(found);
  EXPECT_LT(found->gain_over(0.0), 12.0);
}

TEST(TimingWindow, SaysNothingOfFewPairs) {
  TimingWindow window;
  drive(0.0, 2, 0.1, 1.0, window);
  EXPECT_FALSE(window.evidence());
}

TEST(TimingWindow, IsNotMovedByAFewWrongMatches) {
  TimingWindow window;
  drive(0.0, 20, 0.05, 1.0, window);
  std::mt19937 random(7);
  for (int i = 0; i < 3; ++i) {
    TimedQuantity wrong = measured(3.0 * i, MotionChange::kTurnsMore, 0.05, 1.0, random);
    wrong.by_scans += 0.3;
    window.add(wrong);
  }
  const auto found = window.evidence();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->timing.late_s, 0.05, 0.01);
}

TEST(TimingWindow, ForgetsWhatItKnewOfAnotherLateness) {
  TimingWindow window;
  drive(0.0, 40, 0.1, 1.0, window);
  drive(40.0, 40, 0.0, 1.0, window);
  const auto found = window.evidence();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->timing.late_s, 0.0, 0.008);
  EXPECT_GT(found->gain_over(0.1), 25.0);
}

}  // namespace
}  // namespace slammot::matching
