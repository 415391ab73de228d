#include "services/tracking/termination.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/example_tracks.hpp"

#include "services/tracking/evidence_limits.hpp"

namespace slammot::tracking {
namespace {

using testing::followed_car;
using testing::out_from_behind_others;

TEST(Termination, OfAVehicleThatHasComeMayStandForAsLongAsItIsSeen) {
  const TrackingConfig config;
  constexpr std::int64_t kMinuteNs = 60'000'000'000;
  Track track = followed_car();
  track.existence.travel.travelled_m = 2.0;
  track.history.last_seen_ns = kMinuteNs;
  EXPECT_FALSE(has_stood_too_long(track, kMinuteNs, config));
  EXPECT_TRUE(has_stood_too_long(track, kMinuteNs + 3'000'000'000, config));  // where has it been
                                                                              // since?
  track.existence.travel.travelled_m = 1.0;  // it may be a wall of which more and more came into
                                             // view
  EXPECT_TRUE(has_stood_too_long(track, kMinuteNs, config));
  track.existence.travel.travelled_m = 2.0;
  track.extent.outline = Blob();
  EXPECT_TRUE(has_stood_too_long(track, kMinuteNs, config));
}

TEST(Termination, ThatSeemsToMoveIsWaitedForTwiceAsLong) {
  const TrackingConfig config;
  const Track moving = out_from_behind_others(config);
  Track slow = moving;
  slow.kinematics.estimate.mean.segment<2>(2).setZero();
  Track here = moving;
  here.kinematics.estimate.mean.head<2>().setZero();
  Track unlikely = moving;
  unlikely.existence.score = 0.0;
  const double late_s = evidence_limits(config).longest_tentative_s + 0.1;
  EXPECT_FALSE(is_timed_out(moving, late_s, config));
  EXPECT_TRUE(is_timed_out(moving, 2.0 * late_s, config));
  for (const Track* other : {&slow, &here, &unlikely}) {
    EXPECT_TRUE(is_timed_out(*other, late_s, config));
    EXPECT_FALSE(is_timed_out(*other, evidence_limits(config).longest_tentative_s - 0.1, config));
  }
  slow.existence.confirmed = true;
  EXPECT_FALSE(is_timed_out(slow, late_s, config));
}

/// Moving and seen at this stamp.
Track seen_at(std::int64_t stamp_ns) {
  Track track = followed_car();
  track.history.first_seen_ns = 0;
  track.history.last_seen_ns = track.existence.travel.last_moving_ns = stamp_ns;
  return track;
}

TEST(Termination, ComesAfterAWhileUnseenAndSoonerToATentativeTrack) {
  const TrackingConfig config;
  Track track = seen_at(1'000'000'000);
  const auto ends_after = [&](double unseen_s) {
    return has_ended(track, 1'000'000'000 + static_cast<std::int64_t>(unseen_s * 1e9), config);
  };
  EXPECT_FALSE(ends_after(evidence_limits(config).longest_unseen_tentative_s + 0.1));
  EXPECT_TRUE(ends_after(config.existence.longest_unseen_s + 0.1));
  track.existence.confirmed = false;
  EXPECT_FALSE(ends_after(evidence_limits(config).longest_unseen_tentative_s - 0.1));
  EXPECT_TRUE(ends_after(evidence_limits(config).longest_unseen_tentative_s + 0.1));
}

TEST(Termination, ComesToATrackThatItsScoreRejects) {
  const TrackingConfig config;
  Track track = seen_at(1'000'000'000);
  EXPECT_FALSE(has_ended(track, 1'000'000'000, config));
  track.existence.score = kRejectScore - 0.1;
  EXPECT_TRUE(has_ended(track, 1'000'000'000, config));
}

TEST(Termination, ComesToATrackThatClaimsToMoveAndGetsNowhere) {
  const TrackingConfig config;
  Track track = seen_at(1'000'000'000);
  track.existence.travel.claimed_m = 4.0 * kProgressM - 0.1;
  EXPECT_FALSE(has_ended(track, 1'000'000'000, config));
  track.existence.travel.claimed_m = 4.0 * kProgressM + 0.1;
  EXPECT_TRUE(has_ended(track, 1'000'000'000, config));
}

}  // namespace
}  // namespace slammot::tracking
