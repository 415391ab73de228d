#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/example_tracks.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using testing::Street;
using testing::StreetBox;

constexpr double kPeriodS = 1.0 / 37.5;
const StreetBox kWall{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0};

/// A car that is hidden by a truck for a while, a queue that brakes, and two pedestrians who pass
/// each other, before two scanners.
class BusyStreet {
 public:
  BusyStreet() {
    front_.known = rear_.known = {kWall, {{-40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}};
    rear_.first_beam_rad = 0.5 * M_PI;
  }

  flow::SegmentedScan scan(std::uint32_t sequence) {
    const double now_s = sequence * kPeriodS;
    const bool is_front = sequence % 3 != 2;
    Street& street = is_front ? front_ : rear_;
    street.unknown = scene(now_s);
    flow::LocalizedScan scan = street.scan(static_cast<std::int64_t>(now_s * 1e9), sequence);
    scan.scanner_id = is_front ? "front" : "rear";
    return detection::detect(scan, {});
  }

 private:
  static std::vector<StreetBox> scene(double t) {
    const double queue_m = 6.0 * std::min(t, 3.0);
    return {{{25.0, -16.0 + 8.0 * t, M_PI / 2.0}},  {{14.0, 14.0 - 5.0 * t, M_PI / 2.0}, 8.0, 2.5},
            {{-25.0 + queue_m, 6.0, 0.0}},          {{-34.0 + queue_m, 6.0, 0.0}},
            {{8.0, -3.0 + 1.3 * t, 0.0}, 0.4, 0.5}, {{8.6, 3.0 - 1.3 * t, 0.0}, 0.4, 0.5}};
  }

  Street front_;
  Street rear_;
};

std::vector<std::byte> saved(const Tracker& tracker) {
  std::vector<std::byte> bytes;
  tracker.save(bytes);
  return bytes;
}

TrackingConfig every_estimator() {
  TrackingConfig config;
  config.motion.formations = true;
  config.motion.coordinated_turn = true;
  config.association.most_hypotheses = 6;
  return config;
}

TEST(TrackerState, GoesOnAsUndisturbedFromEveryScan) {
  BusyStreet street;
  Tracker undisturbed(every_estimator());
  Tracker killed(every_estimator());
  std::size_t most_confirmed = 0;
  for (std::uint32_t sequence = 0; sequence < 200; ++sequence) {
    const flow::SegmentedScan scan = street.scan(sequence);
    const TrackingResult& wanted = undisturbed.step(scan);
    const TrackingResult& result = killed.step(scan);
    ASSERT_EQ(result.labels.labels, wanted.labels.labels) << sequence;
    ASSERT_EQ(saved(killed), saved(undisturbed)) << sequence;
    most_confirmed = std::max<std::size_t>(
        most_confirmed,
        std::ranges::count_if(wanted.objects.objects, &flow::TrackedObject::confirmed));
    Tracker next(every_estimator());
    ASSERT_TRUE(next.restore(saved(killed))) << sequence;
    killed = std::move(next);
  }
  EXPECT_GE(most_confirmed, 5U) << "the test needs tracks";
  EXPECT_EQ(undisturbed.counters().tracks_begun, killed.counters().tracks_begun);
}

TEST(TrackerState, ReplacesWhateverTheTrackerHad) {
  BusyStreet street;
  Tracker first({}), second({});
  for (std::uint32_t sequence = 0; sequence < 60; ++sequence) first.step(street.scan(sequence));
  for (std::uint32_t sequence = 10; sequence < 50; ++sequence) second.step(street.scan(sequence));
  ASSERT_TRUE(second.restore(saved(first)));
  first.step(street.scan(60));
  second.step(street.scan(60));
  EXPECT_EQ(saved(first), saved(second));
}

TEST(TrackerState, IsRefusedWhereItIsCutOrOfAnotherVersion) {
  BusyStreet street;
  Tracker tracker({}), other({});
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence) tracker.step(street.scan(sequence));
  const auto bytes = saved(tracker);
  const auto before = saved(other);
  for (std::size_t size = 0; size < bytes.size(); size += 97)
    ASSERT_FALSE(other.restore(std::span(bytes).first(size))) << size;
  auto another = bytes;
  another.front() ^= std::byte{1};
  EXPECT_FALSE(other.restore(another));
  EXPECT_EQ(saved(other), before);
}

TEST(TrackerState, LeavesOutIdsThatLostScansMayHaveGiven) {
  BusyStreet street;
  Tracker tracker({});
  tracker.begin_ids_at(1001);
  const TrackingResult* result = nullptr;
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence)
    result = &tracker.step(street.scan(sequence));
  ASSERT_FALSE(result->objects.objects.empty());
  for (const flow::TrackedObject& object : result->objects.objects)
    EXPECT_GT(object.track_id.value, 1000U);
}

}  // namespace
}  // namespace slammot::tracking
