#include "services/tracking/history.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

History with_one_observation() {
  History history;
  std::vector<Vector2d> points_m = {{1.0, 2.0}, {3.0, 4.0}};
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.01;
  history.observations.add(5, observation, Eigen::Matrix2d::Identity());
  history.past_points.push_back().points.beams = {7, 8};
  history.first_seen_ns = 3;
  return history;  // the points of the caller are gone
}

TEST(History, KeepsThePointsOfItsObservations) {
  const History history = with_one_observation();
  const Observation observation = history.observations[0].with_points();
  ASSERT_EQ(observation.points_m.size(), 2U);
  EXPECT_EQ(observation.points_m[1], Vector2d(3.0, 4.0));
  EXPECT_EQ(observation.beam_step_rad, 0.01);
  EXPECT_EQ(history.observations[0].stamp_ns, 5);
}

TEST(History, DropsTheOldestOfTooManyObservations) {
  History history;
  const std::vector<Vector2d> points_m = {{1.0, 2.0}};
  Observation observation;
  observation.points_m = points_m;
  const auto count = static_cast<std::int64_t>(ObservationHistory::kMost) + 3;
  for (std::int64_t stamp_ns = 0; stamp_ns < count; ++stamp_ns)
    history.observations.add(stamp_ns, observation, Eigen::Matrix2d::Zero());
  EXPECT_EQ(history.observations.size(), ObservationHistory::kMost);
  EXPECT_EQ(history.observations[0].stamp_ns, 3);
}

TEST(History, OfAConfirmedTrackHasNoObservationsButItsStamps) {
  History history = with_one_observation();
  clear_tentative(history);
  EXPECT_EQ(history.observations.size(), 0U);
  EXPECT_TRUE(history.past_points.empty());
  EXPECT_EQ(history.first_seen_ns, 3);
}

TEST(History, EmptiedIsThatOfANewTrack) {
  const History history = emptied(with_one_observation());
  EXPECT_EQ(history.observations.size(), 0U);
  EXPECT_TRUE(history.past_points.empty());
  EXPECT_EQ(history.first_seen_ns, 0);
}

}  // namespace
}  // namespace slammot::tracking
