#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::Street;
using slammot::testing::StreetBox;

constexpr double kPeriodS = 1.0 / 37.5;
constexpr double kSpeedMps = 6.0;
constexpr double kTurnsAfterM = 28.0;
constexpr double kRadiusM = 12.0;
constexpr double kQuarterTurnRad = 0.5 * M_PI;

/// A bus comes along a street across, shows its left flank and its front, turns right, and leaves
/// with its rear and its right flank in view.
StreetBox bus_at(double time_s) {
  const double way_m = kSpeedMps * time_s;
  const double turned_rad = std::clamp((way_m - kTurnsAfterM) / kRadiusM, 0.0, kQuarterTurnRad);
  const double after_m = std::max(0.0, way_m - kTurnsAfterM - kRadiusM * kQuarterTurnRad);
  const double heading_rad = kQuarterTurnRad - turned_rad;
  const Vector2 turn_about_m(20.0 + kRadiusM, -30.0 + kTurnsAfterM);
  const Vector2 centre_m = turn_about_m +
                           kRadiusM * Vector2(-std::cos(turned_rad), std::sin(turned_rad)) +
                           Vector2(after_m, std::min(0.0, way_m - kTurnsAfterM));
  return {{centre_m.x(), centre_m.y(), heading_rad}, 12.0, 2.5};
}

/// Of a point in the frame of the box.
double distance_from_outline_m(const StreetBox& box, const Vector2& at_m) {
  const Vector2 half_m(0.5 * box.length_m, 0.5 * box.width_m);
  const Vector2 beyond_m = at_m.cwiseAbs() - half_m;
  return beyond_m.maxCoeff() < 0.0 ? -beyond_m.maxCoeff() : beyond_m.cwiseMax(0.0).norm();
}

/// Share of the outline within half a metre of a point, all in the frame of the box.
double share_near(const StreetBox& box, const std::vector<Vector2>& points_m) {
  constexpr double kStepM = 0.25;
  std::vector<Vector2> outline_m;
  for (double x_m = -0.5 * box.length_m; x_m <= 0.5 * box.length_m; x_m += kStepM)
    for (const double side : {-0.5, 0.5}) outline_m.emplace_back(x_m, side * box.width_m);
  for (double y_m = -0.5 * box.width_m; y_m <= 0.5 * box.width_m; y_m += kStepM)
    for (const double side : {-0.5, 0.5}) outline_m.emplace_back(side * box.length_m, y_m);
  const auto is_near = [&](const Vector2& place_m) {
    return std::ranges::any_of(points_m,
                               [&](const Vector2& at_m) { return (at_m - place_m).norm() < 0.5; });
  };
  return static_cast<double>(std::ranges::count_if(outline_m, is_near)) /
         static_cast<double>(outline_m.size());
}

TEST(TurningBus, HasItsWholeOutlineAndOneHeading) {
  Tracker tracker({});
  std::set<std::uint32_t> ids;
  double worst_heading_rad = 0.0;
  flow::TrackedObject bus;
  double time_s = 0.0;
  for (std::uint32_t scan = 0; time_s < 9.0; ++scan) {
    time_s = scan * kPeriodS;
    const auto stamp_ns = static_cast<std::int64_t>(time_s * 1e9);
    Street street;
    street.known = {{{70.0, 0.0, M_PI / 2.0}, 160.0, 1.0}};
    street.unknown = {bus_at(time_s)};
    const TrackingResult& result = tracker.step(detection::detect(street.scan(stamp_ns, scan), {}));
    for (const flow::TrackedObject& object : result.objects.objects) {
      if (!object.confirmed) continue;
      ids.insert(object.track_id.value);
      bus = object;
      if (time_s > 2.0)
        worst_heading_rad = std::max(
            worst_heading_rad,
            std::abs(object.heading_in_odom_rad - bus_at(time_s).odom_from_box.heading_rad));
    }
  }
  const StreetBox truth = bus_at(time_s);
  std::vector<Vector2> contour_m;
  for (const Eigen::Vector2f& at_m : bus.contour_in_odom_m)
    contour_m.push_back(geometry::inverse(truth.odom_from_box) * at_m.cast<double>());
  EXPECT_EQ(ids.size(), 1U);
  EXPECT_LT(worst_heading_rad, 0.1);
  EXPECT_NEAR(bus.length_m, 12.0, 0.3);
  EXPECT_GT(share_near(truth, contour_m), 0.95);
  for (const Vector2& at_m : contour_m) EXPECT_LT(distance_from_outline_m(truth, at_m), 0.3);
}

}  // namespace
}  // namespace slammot::tracking
