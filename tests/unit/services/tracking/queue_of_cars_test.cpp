#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using slammot::testing::Street;

constexpr double kPeriodS = 1.0 / 37.5;
constexpr double kApartM = 13.0;

/// Way of a queue that brakes from 8 to 2 m/s.
double way_m(double time_s) {
  constexpr double kBrakesAtS = 2.6;
  const double braking_s = std::clamp(time_s - kBrakesAtS, 0.0, 2.0);
  return 8.0 * std::min(time_s, kBrakesAtS) + 8.0 * braking_s - 1.5 * braking_s * braking_s +
         2.0 * std::max(0.0, time_s - kBrakesAtS - 2.0);
}

struct Hidden {
  double longest_s = 0.0;  ///< For how long it was not seen.
  double worst_m = 0.0;    ///< Error of its published place meanwhile.
};

/// The middle one of three cars, which a container hides while all brake; the others are seen at
/// times.
Hidden middle_of_a_queue(bool formations) {
  TrackingConfig config;
  config.motion.formations = formations;
  Tracker tracker(config);
  const auto y_of = [](int car, double time_s) {
    return -23.0 - kApartM * (car - 1) + way_m(time_s);
  };
  std::uint32_t middle = 0;
  Hidden hidden;
  for (std::uint32_t scan = 0; scan * kPeriodS < 3.7; ++scan) {
    const double time_s = scan * kPeriodS;
    const auto stamp_ns = static_cast<std::int64_t>(time_s * 1e9);
    Street street;
    street.known = {{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}, {{10.0, 0.0, M_PI / 2.0}, 6.0, 1.0}};
    for (int car = 0; car < 3; ++car)
      street.unknown.push_back({{20.0, y_of(car, time_s), M_PI / 2.0}});
    const TrackingResult& result = tracker.step(detection::detect(street.scan(stamp_ns, scan), {}));
    for (const flow::TrackedObject& object : result.objects.objects) {
      const double error_m = std::abs(object.position_in_odom_m.y() - y_of(1, time_s));
      if (time_s < 1.5 && object.confirmed && error_m < 2.0) middle = object.track_id.value;
      if (object.track_id.value != middle || object.last_seen_ns == stamp_ns) continue;
      hidden.longest_s =
          std::max(hidden.longest_s, static_cast<double>(stamp_ns - object.last_seen_ns) * 1e-9);
      hidden.worst_m = std::max(hidden.worst_m, error_m);
    }
  }
  return hidden;
}

TEST(QueueOfCars, TellsWhereOneOfThemIsThatIsHiddenWhileAllBrake) {
  const Hidden alone = middle_of_a_queue(false);
  const Hidden together = middle_of_a_queue(true);
  EXPECT_GT(alone.longest_s, 1.0);
  EXPECT_GT(alone.worst_m, 0.8);
  EXPECT_GT(together.longest_s, 1.0);
  EXPECT_LT(together.worst_m, 0.2);
}

}  // namespace
}  // namespace slammot::tracking
