#include "services/tracking/competing_tracks.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "services/tracking/association_cost.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using geometry::Vector2;
using testing::Street;
using testing::StreetBox;

constexpr double kPeriodS = 1.0 / 37.5;

TrackingConfig config_with(int most_hypotheses) {
  TrackingConfig config;
  config.association.most_hypotheses = most_hypotheses;
  return config;
}

/// Two who walk over the street from both sides and pass each other, the second behind the first,
/// at t = 4 s.
struct Passing {
  double speed_mps = 1.2;
  double apart_m = 0.6;

  Vector2 walker_at(int who, double t) const {
    return who == 0 ? Vector2(10.0, speed_mps * (t - 4.0))
                    : Vector2(10.0 + apart_m, -speed_mps * (t - 4.0));
  }
};

/// Ids of the tracks at the two walkers at the end, 0 where there is none.
std::vector<std::uint32_t> ids_after(const TrackingConfig& config, const Passing& passing,
                                     double seconds) {
  Tracker tracker(config);
  Street street{{{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}}, {}, {}};
  TrackingResult result;
  for (int scan = 0; scan < std::lround(seconds / kPeriodS); ++scan) {
    const double t = scan * kPeriodS;
    street.unknown.clear();
    for (const int who : {0, 1})
      street.unknown.push_back(
          {{passing.walker_at(who, t).x(), passing.walker_at(who, t).y(), 0.0}, 0.4, 0.5});
    result = tracker.step(detection::detect(
        street.scan(static_cast<std::int64_t>(t * 1e9), static_cast<std::uint32_t>(scan)), {}));
  }
  std::vector<std::uint32_t> ids;
  for (const int who : {0, 1}) {
    ids.push_back(0);
    for (const flow::TrackedObject& object : result.objects.objects)
      if (object.confirmed &&
          (object.position_in_odom_m - passing.walker_at(who, seconds)).norm() < 0.5)
        ids.back() = object.track_id.value;
  }
  return ids;
}

TEST(CompetingTracks, KeepTheirNamesWhenTheyPassEachOther) {
  for (const Passing& passing : {Passing{}, Passing{0.8, 0.2}, Passing{1.6, 0.4}}) {
    for (const int most_hypotheses : {1, 6}) {
      const auto before = ids_after(config_with(most_hypotheses), passing, 3.0);
      ASSERT_NE(before[0], 0U);
      ASSERT_NE(before[1], 0U);
      EXPECT_EQ(ids_after(config_with(most_hypotheses), passing, 6.0), before)
          << passing.speed_mps << " " << most_hypotheses;
    }
  }
}

TEST(CompetingTracks, AreTrackedAsByTheBestAssignmentWhileTheyAreFarApart) {
  EXPECT_EQ(ids_after(config_with(6), {}, 2.5), ids_after(config_with(1), {}, 2.5));
}

TEST(CompetingTracks, AreOnlyConfirmedTracksWithoutSides) {
  CompetingTracks competing_tracks(config_with(6));
  Street street{{}, {}, {{{10.0, 0.0, 0.0}, 0.4, 0.5}}};
  const flow::SegmentedScan scan = detection::detect(street.scan(0, 0), {});
  const ScanView view(scan);
  std::vector<Track> tracks(3);
  for (std::uint32_t i = 0; i < 3; ++i) tracks[i].track_id = {i + 1};
  tracks[0].existence.confirmed = tracks[1].existence.confirmed = true;
  tracks[1].extent.outline = Box();
  competing_tracks.decide(tracks, view, [](std::size_t, std::size_t) { return true; });
  EXPECT_TRUE(competing_tracks.has(tracks[0]));
  EXPECT_FALSE(competing_tracks.has(tracks[1]));
  EXPECT_FALSE(competing_tracks.has(tracks[2]));
  tracks.erase(tracks.begin());
  competing_tracks.decide(tracks, view, [](std::size_t, std::size_t) { return true; });
  Track gone;
  gone.track_id = {1};
  EXPECT_FALSE(competing_tracks.has(gone));  // forgotten with the track
}

}  // namespace
}  // namespace slammot::tracking
