#include "services/tracking/merging.hpp"

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

constexpr std::int64_t kNow_ns = 5'000'000'000;

/// One that is followed for long at this place, seen now.
Track at(const Eigen::Vector2d& position_m, std::uint32_t id) {
  Track track;
  track.track_id = {id};
  track.existence.confirmed = true;
  track.existence.hits = 100;
  track.existence.mean_echoes = 10.0;
  track.history.last_seen_ns = kNow_ns;
  track.kinematics.estimate.mean << position_m, 1.2, 0.0, 0.0, 0.0;
  track.kinematics.estimate.covariance = 0.01 * track.kinematics.estimate.covariance.Identity();
  return track;
}

Track walker(const Eigen::Vector2d& position_m, std::uint32_t id) {
  Track track = at(position_m, id);
  track.extent.footprint().length = track.extent.footprint().width = {0.5, 0.01};
  track.classification.probability = {0.97, 0.01, 0.01, 0.01};
  return track;
}

Track car(const Eigen::Vector2d& position_m, std::uint32_t id) {
  Track track = at(position_m, id);
  track.extent.outline = Box();
  track.extent.footprint().length = {4.3, 0.01};
  track.extent.footprint().width = {1.7, 0.01};
  track.classification.probability = {0.01, 0.01, 0.97, 0.01};
  return track;
}

void expect_only_first_is_superfluous(const Track& track, const Track& other) {
  EXPECT_TRUE(is_duplicate(track, other, {}));
  EXPECT_FALSE(is_duplicate(other, track, {}));
}

TEST(Merging, AreNotWhatIsApart) {
  const Track one = car({10.0, 0.0}, 1);
  const Track other = car({10.0, 2.5}, 2);
  EXPECT_FALSE(is_duplicate(one, other, {}));
  EXPECT_FALSE(is_duplicate(other, one, {}));
}

TEST(Merging, OfOneCarEndWithTheYounger) {
  const Track one = car({10.0, 0.0}, 1);
  const Track other = car({10.5, 0.2}, 2);
  expect_only_first_is_superfluous(other, one);
}

TEST(Merging, AreCarsThroughWhichSomebodyIsSeenToWalk) {
  const Track one = car({10.0, 0.0}, 1);
  const Track inside = walker({11.0, 0.3}, 2);
  expect_only_first_is_superfluous(one, inside);
}

TEST(Merging, AreThoseInsideACarWhoMayNotWalk) {
  const Track one = car({10.0, 0.0}, 1);
  Track inside = walker({11.0, 0.3}, 2);
  inside.existence.hits = 10;  // perhaps a corner of it
  expect_only_first_is_superfluous(inside, one);
}

TEST(Merging, AreThoseInsideACarWhoAreHidden) {
  const Track one = car({10.0, 0.0}, 1);
  Track inside = walker({11.0, 0.3}, 2);
  inside.history.last_seen_ns = kNow_ns - 1'000'000'000;  // behind it, and thought to be in it
  expect_only_first_is_superfluous(inside, one);
}

}  // namespace
}  // namespace slammot::tracking
