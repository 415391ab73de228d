#include "common/sensing/gyro_odometry.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using slammot::testing::PoseNear;

constexpr std::int64_t kPeriod_ns = 20'000'000;  // of odometry; the gyro is twice as fast
constexpr double kPeriod_s = 0.02;

/// A vehicle whose wheels count turns by a factor, with a gyro.
class Vehicle {
 public:
  Vehicle(double turn_factor, double bias_radps) : factor_(turn_factor), bias_radps_(bias_radps) {}

  /// The sample at the end of a time with this motion.
  Pose2 drive(GyroOdometry& odometry, double duration_s, double speed_mps, double yaw_rate_radps) {
    Pose2 fused;
    for (int i = 0; i < static_cast<int>(std::lround(duration_s / kPeriod_s)); ++i) {
      const double turn_rad = yaw_rate_radps * kPeriod_s;
      truth_ = truth_ * arc(speed_mps * kPeriod_s, turn_rad);
      wheels_ = wheels_ * arc(speed_mps * kPeriod_s, factor_ * turn_rad);
      if (has_gyro) {
        odometry.add({stamp_ns_ + kPeriod_ns / 2, yaw_rate_radps + bias_radps_});
        odometry.add({stamp_ns_ + kPeriod_ns, yaw_rate_radps + bias_radps_});
      }
      stamp_ns_ += kPeriod_ns;
      fused = odometry.fused({stamp_ns_, wheels_}).wheel_from_base;
    }
    return fused;
  }

  const Pose2& truth() const { return truth_; }
  const Pose2& wheels() const { return wheels_; }
  bool has_gyro = true;

 private:
  static Pose2 arc(double way_m, double turn_rad) {
    return {way_m * std::cos(0.5 * turn_rad), way_m * std::sin(0.5 * turn_rad), turn_rad};
  }

  double factor_;
  double bias_radps_;
  std::int64_t stamp_ns_ = 0;
  Pose2 truth_, wheels_;
};

TEST(GyroOdometry, TurnsByTheGyroWhereTheWheelsSlip) {
  GyroOdometry odometry;
  Vehicle vehicle(1.15, 0.0);
  vehicle.drive(odometry, 10.0, 5.0, 0.0);                  // until its bias is known,
  vehicle.drive(odometry, 6.0, 5.0, std::numbers::pi / 6);  // and turns have been compared
  const Pose2 truth_before = vehicle.truth();
  const Pose2 before = vehicle.drive(odometry, 0.02, 5.0, std::numbers::pi / 6);
  const Pose2 wheels_before = vehicle.wheels();
  const Pose2 after = vehicle.drive(odometry, 5.98, 5.0, std::numbers::pi / 6);
  EXPECT_THAT(inverse(before) * after, PoseNear(inverse(truth_before) * vehicle.truth(), 0.2));
  EXPECT_GT(std::abs((inverse(wheels_before) * vehicle.wheels()).heading_rad), 0.4);
}

TEST(GyroOdometry, BelievesNoGyroThatIsMountedUpsideDownOrCountsDegrees) {
  for (const double factor : {-1.0, 1.0 / 57.3}) {  // of the wheels, against that of the gyro
    GyroOdometry odometry;
    Vehicle vehicle(factor, 0.0);
    vehicle.drive(odometry, 10.0, 5.0, 0.0);
    const Pose2 fused = vehicle.drive(odometry, 20.0, 5.0, 0.5);
    EXPECT_THAT(fused, PoseNear(vehicle.wheels(), 1e-6));
    EXPECT_FALSE(odometry.is_believed());
  }
}

TEST(GyroOdometry, MeasuresTheBiasWhileTheWheelsStand) {
  GyroOdometry odometry;
  Vehicle vehicle(1.0, 0.01);
  vehicle.drive(odometry, 4.0, 5.0, 0.5);
  vehicle.drive(odometry, 10.0, 0.0, 0.0);
  EXPECT_NEAR(odometry.bias_radps(), 0.01, 1e-4);
  EXPECT_LT(odometry.bias_sigma_radps(), 0.002);
  const Pose2 before = vehicle.drive(odometry, 0.02, 0.0, 0.0);
  const Pose2 after = vehicle.drive(odometry, 20.0, 5.0, 0.0);
  EXPECT_NEAR(geometry::wrap_angle(after.heading_rad - before.heading_rad), 0.0, 0.003);
}

TEST(GyroOdometry, MeasuresTheBiasOnAStraight) {
  GyroOdometry odometry;
  Vehicle vehicle(1.15, 0.02);
  vehicle.drive(odometry, 20.0, 5.0, 0.0);
  vehicle.drive(odometry, 5.0, 5.0, 0.3);
  vehicle.drive(odometry, 5.0, 5.0, -0.5);
  EXPECT_TRUE(odometry.is_believed());
  EXPECT_NEAR(odometry.bias_radps(), 0.02, 0.002);
}

TEST(GyroOdometry, TellsForHowLongItWasUsed) {
  GyroOdometry odometry;
  Vehicle vehicle(1.15, 0.02);
  vehicle.drive(odometry, 20.0, 5.0, 0.0);
  EXPECT_EQ(odometry.use().used_s, 0.0);
  EXPECT_EQ(odometry.use().turn_ratio, 0.0);
  vehicle.drive(odometry, 10.0, 5.0, 0.3);
  const GyroUse use = odometry.use();
  EXPECT_NEAR(use.read_s, 30.0, 0.1);
  EXPECT_GT(use.used_s, 5.0);
  EXPECT_LT(use.used_s, 10.0);
  EXPECT_NEAR(use.turn_ratio, 1.0 / 1.15, 0.02);
}

TEST(GyroOdometry, IsNotBelievedBeforeItsBiasIsKnown) {
  GyroOdometry odometry;
  Vehicle vehicle(1.0, 0.02);
  const Pose2 fused = vehicle.drive(odometry, 4.0, 5.0, 0.5);
  EXPECT_FALSE(odometry.is_believed());
  EXPECT_THAT(fused, PoseNear(vehicle.truth(), 0.1));
}

TEST(GyroOdometry, TakesNoTurnForABias) {
  GyroOdometry odometry;
  Vehicle vehicle(0.0, 0.0);  // wheels that count nothing while a turntable turns the vehicle
  vehicle.drive(odometry, 5.0, 0.0, 0.0);
  vehicle.drive(odometry, 5.0, 0.0, 0.5);
  EXPECT_NEAR(odometry.bias_radps(), 0.0, 1e-6);
}

TEST(GyroOdometry, IsThatOfTheWheelsWithoutReadings) {
  GyroOdometry odometry;
  Vehicle vehicle(1.15, 0.0);
  vehicle.has_gyro = false;
  const Pose2 fused = vehicle.drive(odometry, 4.0, 5.0, 0.3);
  EXPECT_THAT(fused, PoseNear(vehicle.wheels(), 1e-9));
  EXPECT_FALSE(odometry.has_readings());
}

TEST(GyroOdometry, GoesOnByTheWheelsWhereReadingsStop) {
  GyroOdometry odometry;
  Vehicle vehicle(1.1, 0.0);
  vehicle.drive(odometry, 10.0, 5.0, 0.0);
  vehicle.drive(odometry, 4.0, 5.0, 0.3);
  ASSERT_TRUE(odometry.is_believed());
  vehicle.has_gyro = false;
  const double before_rad = vehicle.drive(odometry, 1.0, 5.0, 0.0).heading_rad;
  const Pose2 after = vehicle.drive(odometry, 2.0, 5.0, 0.3);
  EXPECT_NEAR(geometry::wrap_angle(after.heading_rad - before_rad), 1.1 * 0.6, 1e-6);
}

TEST(GyroOdometry, MakesUpForReadingsThatComeLate) {
  GyroOdometry in_time;
  GyroOdometry late;
  Pose2 with_late, with_all;
  double turned_rad = 0.0;
  for (std::int64_t i = 1; i <= 600; ++i) {
    const double rate_radps = i < 200 ? 0.0 : 0.5 + 0.3 * std::sin(0.1 * static_cast<double>(i));
    const TurnRate reading{i * kPeriod_ns, rate_radps};
    turned_rad += 1.1 * kPeriod_s * reading.yaw_rate_radps;
    const Odometry wheels{i * kPeriod_ns, {0.0, 0.0, geometry::wrap_angle(turned_rad)}};
    in_time.add(reading);
    with_all = in_time.fused(wheels).wheel_from_base;
    with_late = late.fused(wheels).wheel_from_base;
    late.add(reading);
  }
  ASSERT_TRUE(late.is_believed());
  EXPECT_NEAR(geometry::wrap_angle(with_late.heading_rad - with_all.heading_rad), 0.0, 0.02);
}

}  // namespace
}  // namespace slammot::sensing
