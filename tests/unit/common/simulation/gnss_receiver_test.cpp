#include "common/simulation/gnss_receiver.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using sensing::GnssQuality;

constexpr int kFixes = 2000;

/// Walls at both sides of a street that goes east.
Outline canyon(double half_width_m) {
  Outline outline;
  for (const double y_m : {-half_width_m, half_width_m})
    outline.segments.push_back({{-500.0, y_m}, {500.0, y_m}, Material::wall});
  return outline;
}

struct Errors {
  int fixes = 0;
  double rms_m = 0.0;
  double mean_hdop = 0.0;
  double mean_nees = 0.0;
};

/// Each fix by a receiver of its own, so that the slow errors average too.
Errors errors_in(const Outline& outline, const GnssConfig& config, const Pose2& place) {
  Errors errors;
  for (int i = 0; i < kFixes; ++i) {
    GnssReceiver receiver(config, outline, static_cast<std::uint64_t>(i));
    const sensing::GnssFix fix = receiver.fix(place, 1.0, 5.0);
    if (fix.quality == GnssQuality::no_fix) continue;
    ++errors.fixes;
    const Vector2 error_m =
        geometry::east_north_m({config.latitude_deg, config.longitude_deg}, fix.position) -
        place.translation_m();
    errors.rms_m += error_m.squaredNorm();
    errors.mean_hdop += fix.hdop;
    errors.mean_nees += error_m.dot(fix.covariance_m2.inverse() * error_m);
  }
  errors.rms_m = std::sqrt(errors.rms_m / std::max(1, errors.fixes));
  errors.mean_hdop /= std::max(1, errors.fixes);
  errors.mean_nees /= std::max(1, errors.fixes);
  return errors;
}

TEST(GnssReceiver, BelievesWhatItIsWorthUnderAnOpenSky) {
  const Errors open = errors_in({}, {}, {120.0, -40.0, 0.3});
  EXPECT_EQ(open.fixes, kFixes);
  EXPECT_NEAR(open.mean_nees, 2.0, 0.25);  // two degrees of freedom
  EXPECT_LT(open.rms_m, 2.5);
}

TEST(GnssReceiver, LosesFixesAndGrowsWorseBetweenHouses) {
  const Errors open = errors_in({}, {}, {});
  const Errors street = errors_in(canyon(12.0), {}, {});
  const Errors alley = errors_in(canyon(3.0), {}, {});
  EXPECT_LT(street.fixes, kFixes);
  EXPECT_LT(alley.fixes, street.fixes / 2);
  EXPECT_GT(street.mean_hdop, 1.5 * open.mean_hdop);
  EXPECT_GT(street.rms_m, 2.0 * open.rms_m);
}

TEST(GnssReceiver, KeepsItsSlowErrorsFromFixToFix) {
  GnssConfig config;
  config.range_error_m = 0.0;
  GnssReceiver receiver(config, {}, 3);
  const auto error_m = [&](const sensing::GnssFix& fix) {
    return geometry::east_north_m({config.latitude_deg, config.longitude_deg}, fix.position);
  };
  const Vector2 first = error_m(receiver.fix({}, 0.0, 0.0));
  EXPECT_LT((error_m(receiver.fix({}, 0.2, 0.0)) - first).norm(), 0.3);
  double apart_m = 0.0;
  for (int i = 0; i < 20; ++i)
    apart_m = std::max(apart_m, (error_m(receiver.fix({}, 600.0, 0.0)) - first).norm());
  EXPECT_GT(apart_m, 1.0);
}

TEST(GnssReceiver, LooksOverLowHouses) {
  GnssConfig config;
  config.building_height_m = 1.8;
  EXPECT_EQ(errors_in(canyon(12.0), config, {}).fixes, kFixes);
}

}  // namespace
}  // namespace slammot::simulation
