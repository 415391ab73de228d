#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::Street;

constexpr double kPeriodS = 1.0 / 37.5;
constexpr double kStartsAtS = 2.0;

struct Noticed {
  double after_s = 0.0;  ///< Since it started off.
  double way_m = 0.0;    ///< That it had come by then.
  Vector2 velocity_in_odom_mps;
};

/// When a car, of which the map learns at once, that starts off in the direction in which it stands
/// is published as confirmed.
std::optional<Noticed> noticed(const Pose2& odom_from_car,
                               const std::function<double(double)>& way_after_m) {
  Tracker tracker{TrackingConfig()};
  for (std::uint32_t scan = 0; scan * kPeriodS < 7.0; ++scan) {
    const double time_s = scan * kPeriodS;
    const double after_s = time_s - kStartsAtS;
    const double way_m = after_s > 0.0 ? way_after_m(after_s) : 0.0;
    Street street;
    street.known = {{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0},
                    {odom_from_car * Pose2{way_m, 0.0, 0.0}}};
    const TrackingResult& result = tracker.step(
        detection::detect(street.scan(static_cast<std::int64_t>(time_s * 1e9), scan), {}));
    for (const flow::TrackedObject& object : result.objects.objects)
      if (object.confirmed) return Noticed{after_s, way_m, object.velocity_in_odom_mps};
  }
  return std::nullopt;
}

TEST(CreepingVehicle, IsNoticedBeforeItHasComeHalfAMetreHoweverItStands) {
  for (const double heading_rad : {-0.6, -0.3, 0.0, 0.3, 0.6}) {
    const auto found =
        noticed({14.0, 0.0, heading_rad}, [](double after_s) { return 0.5 * after_s * after_s; });
    ASSERT_TRUE(found) << heading_rad;
    EXPECT_GT(found->way_m, 0.0) << heading_rad << ": before it went";
    EXPECT_LT(found->way_m, 0.5) << heading_rad;
    const double speed_mps = std::sqrt(2.0 * found->way_m);  // at 1 m/s^2
    EXPECT_NEAR(std::atan2(found->velocity_in_odom_mps.y(), found->velocity_in_odom_mps.x()),
                heading_rad, 0.1);
    EXPECT_NEAR(found->velocity_in_odom_mps.norm(), speed_mps, 0.3 * speed_mps) << heading_rad;
  }
}

TEST(CreepingVehicle, IsNoticedThoughOnlyItsFlankIsSeenWhichSlidesAlongItself) {
  for (const double speed_mps : {0.65, 0.8}) {
    const auto found =
        noticed({14.0, 4.0, M_PI / 2.0}, [&](double after_s) { return speed_mps * after_s; });
    ASSERT_TRUE(found) << speed_mps;
    EXPECT_GT(found->after_s, 0.0) << speed_mps;
    EXPECT_LT(found->after_s, 3.0) << speed_mps;
    EXPECT_NEAR(found->velocity_in_odom_mps.y(), speed_mps, 0.1);
    EXPECT_NEAR(found->velocity_in_odom_mps.x(), 0.0, 0.1);
  }
}

}  // namespace
}  // namespace slammot::tracking
