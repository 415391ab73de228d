#include "services/collision_warning/object_motion.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace slammot::collision_warning {
namespace {

using Eigen::Vector2d;

/// State after `duration_s` of published velocities.
CourseState after(double duration_s, const std::function<Vector2d(double)>& velocity_mps,
                  std::int64_t gap_ns = 0) {
  ObjectMotion motion;
  CourseState state;
  std::int64_t stamp_ns = 1'000'000'000;
  for (double t = 0.0; t < duration_s; t += 0.027) {
    flow::TrackedObject object;
    object.velocity_in_odom_mps = velocity_mps(t);
    object.heading_in_odom_rad = 1.0;
    state = motion.update(stamp_ns, object);
    stamp_ns += 27'000'000 + gap_ns;
  }
  return state;
}

Vector2d along(double course_rad, double speed_mps) {
  return speed_mps * Vector2d(std::cos(course_rad), std::sin(course_rad));
}

TEST(ObjectMotion, SeesBrakingWithinHalfASecond) {
  const CourseState state =
      after(2.5, [](double t) { return along(0.3, 10.0 - 5.0 * std::max(0.0, t - 2.0)); });
  EXPECT_NEAR(state.speed_mps, 7.5, 0.3);
  EXPECT_LT(state.acceleration_mps2, -2.0);
  EXPECT_NEAR(state.yaw_rate_radps, 0.0, 0.01);
}

TEST(ObjectMotion, SeesATurnThroughTheWrapOfTheCourse) {
  const CourseState state = after(2.0, [](double t) { return along(2.9 + 0.4 * t, 8.0); });
  EXPECT_NEAR(state.yaw_rate_radps, 0.4, 0.12);
  EXPECT_NEAR(state.acceleration_mps2, 0.0, 0.1);
}

TEST(ObjectMotion, TakesTheHeadingOfTheBoxForTheCourseOfOneThatStands) {
  EXPECT_NEAR(after(1.0, [](double) { return Vector2d(0.1, -0.1); }).course_rad, 1.0, 1e-9);
}

TEST(ObjectMotion, StartsAgainAfterAGap) {
  const CourseState state = after(
      2.0, [](double t) { return along(0.0, 10.0 - 3.0 * t); }, 600'000'000);
  EXPECT_EQ(state.acceleration_mps2, 0.0);
}

}  // namespace
}  // namespace slammot::collision_warning
