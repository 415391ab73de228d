#include "services/localization/odometry_prediction.hpp"

#include <functional>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::PoseNear;

constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr double kPeriod_s = 0.1;

/// A match that is believed and puts the base at the pose, 1 cm and 1 mrad sure.
ScanMatch matched_at(const Pose2& odom_from_base) {
  const geometry::Matrix3 covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  return {.odom_from_base = {odom_from_base, covariance}, .is_believed = true};
}

ScanMatch without_match(const Step& step) { return {.odom_from_base = step.prior()}; }

/// A vehicle that goes straight on at 5 m/s, with odometry at each scan.
class OdometryPredictionTest : public ::testing::Test {
 protected:
  static constexpr double kSpeed_mps = 5.0;

  static Pose2 pose_at(int scan) { return {kSpeed_mps * kPeriod_s * scan, 0.0, 0.0}; }
  static std::int64_t stamp_ns(int scan) { return kPeriod_ns * scan; }

  void drive(int first, int last) {
    for (int scan = first; scan < last; ++scan) {
      prediction_.add({stamp_ns(scan), wheel_from_odom_ * pose_at(scan)});
      if (scan == 0) prediction_.begin(0);
      else prediction_.observe(prediction_.predict(stamp_ns(scan)), matched_at(pose_at(scan)));
    }
  }

  Pose2 wheel_from_odom_{3.0, -7.0, 2.0};
  OdometryPrediction prediction_{LocalizerConfig{}};
};

TEST_F(OdometryPredictionTest, PredictsTheStepThatOdometryReports) {
  drive(0, 5);
  prediction_.add({stamp_ns(5), wheel_from_odom_ * pose_at(5)});
  const Step step = prediction_.predict(stamp_ns(5));
  EXPECT_EQ(step.source, StepSource::kOdometry);
  EXPECT_DOUBLE_EQ(step.duration_s, kPeriod_s);
  EXPECT_THAT(step.after.odom_from_base, PoseNear(pose_at(5), 0.01));
  EXPECT_NEAR(step.speed_mps, kSpeed_mps, 0.1);
}

/// It brakes to 2 m/s and begins to turn with 1 rad/s at scan 5.
TEST_F(OdometryPredictionTest, TakesTheMotionOfASlowSweepFromOdometryDuringIt) {
  constexpr double kSweep_s = 0.09;
  drive(0, 5);
  const auto add_later = [this](double after_s) {
    const Pose2 moved{2.0 * after_s, 0.0, 1.0 * after_s};
    prediction_.add({stamp_ns(5) + to_ns(after_s), wheel_from_odom_ * pose_at(5) * moved});
  };
  add_later(0.0);
  EXPECT_NEAR(prediction_.predict(stamp_ns(5), kSweep_s).speed_mps, kSpeed_mps, 0.1)
      << "odometry ends before the sweep";
  add_later(0.05);
  EXPECT_NEAR(prediction_.predict(stamp_ns(5), kSweep_s).yaw_rate_radps, 1.0, 0.01)
      << "odometry reaches half of the sweep";
  add_later(0.1);
  const Step swept = prediction_.predict(stamp_ns(5), kSweep_s);
  EXPECT_NEAR(swept.speed_mps, 2.0, 0.1);
  EXPECT_NEAR(swept.yaw_rate_radps, 1.0, 0.01);
  EXPECT_THAT(swept.after.odom_from_base, PoseNear(pose_at(5), 0.01)) << "the stamp's pose";
  EXPECT_NEAR(prediction_.predict(stamp_ns(5), 0.01).speed_mps, kSpeed_mps, 0.1)
      << "a quick sweep is over before the velocity changes";
}

/// A vehicle that goes straight on at 5 m/s, whose wheels turn at random, beside sure scans.
class NoisyTurns {
 public:
  explicit NoisyTurns(double noise_rad, std::int64_t period_ns = 26'666'667)
      : noise_(0.0, noise_rad), period_ns_(period_ns) {
    prediction_.add({0, wheel_from_base_});
    prediction_.begin(0);
  }

  Step predicted_after(double turn_by_wheels_rad) {
    stamp_ns_ += period_ns_;
    way_m_ = 5e-9 * static_cast<double>(period_ns_);
    wheel_from_base_ = wheel_from_base_ * Pose2{way_m_, 0.0, turn_by_wheels_rad};
    prediction_.add({stamp_ns_, wheel_from_base_});
    return prediction_.predict(stamp_ns_);
  }

  void drive(int scans) {
    const geometry::Matrix3 information = Eigen::Vector3d(1e4, 1e4, 1e6).asDiagonal();
    for (int scan = 0; scan < scans; ++scan) {
      const Step step = predicted_after(noise_(random_));
      truth_ = truth_ * Pose2{way_m_, 0.0, 0.0};
      const geometry::UncertainPose2 prior = step.prior();
      const geometry::Matrix3 covariance = (prior.covariance.inverse() + information).inverse();
      const Eigen::Vector3d change =
          covariance * information * geometry::difference(truth_, prior.pose);
      const Pose2 matched{prior.pose.x_m + change.x(), prior.pose.y_m + change.y(),
                          prior.pose.heading_rad + change.z()};
      prediction_.observe(step, {.odom_from_base = {matched, covariance}, .is_believed = true});
    }
  }

  const OdometryPrediction& prediction() const { return prediction_; }

 private:
  std::mt19937 random_{7};
  std::normal_distribution<double> noise_;
  std::int64_t period_ns_;
  std::int64_t stamp_ns_ = 0;
  double way_m_ = 0.0;
  Pose2 wheel_from_base_;
  Pose2 truth_;
  OdometryPrediction prediction_{LocalizerConfig{}};
};

TEST(NoisyTurnsTest, LeaveTheTurnToScansAndToTheTurnBefore) {
  NoisyTurns drive(0.003);
  drive.drive(400);
  const Step step = drive.predicted_after(0.006);
  EXPECT_NEAR(std::sqrt(step.wheels.turn_variance_rad2), 3.0 * 0.003, 0.002);
  EXPECT_LT(step.before_from_base.heading_rad, 0.004) << "it turned by 6 mrad by the wheels";
  EXPECT_GT(step.prior().covariance(2, 2), 0.003 * 0.003);
}

TEST(NoisyTurnsTest, AreNotStampsThatAreEarlyOrLate) {
  NoisyTurns drive(0.003);
  drive.drive(2000);
  EXPECT_FALSE(drive.prediction().state().applies_stamp_offset);
}

TEST(NoisyTurnsTest, AreNotThoseOfSoundWheels) {
  NoisyTurns drive(0.0003);
  drive.drive(400);
  const Step step = drive.predicted_after(0.006);
  EXPECT_EQ(step.wheels.turn_variance_rad2, 0.0);
  EXPECT_NEAR(step.before_from_base.heading_rad, 0.006, 1e-3);
}

TEST(NoisyTurnsTest, AreNotToldWhereScansComeSeldom) {
  NoisyTurns drive(0.01, 200'000'000);
  drive.drive(100);
  EXPECT_EQ(drive.predicted_after(0.006).wheels.turn_variance_rad2, 0.0);
}

TEST_F(OdometryPredictionTest, ChangesNothingByPredicting) {
  drive(0, 5);
  prediction_.add({stamp_ns(5), wheel_from_odom_ * pose_at(5)});
  const Step first = prediction_.predict(stamp_ns(5));
  const Step second = prediction_.predict(stamp_ns(5));
  EXPECT_EQ(first.after.odom_from_base, second.after.odom_from_base);
  EXPECT_EQ(prediction_.last()->stamp_ns, stamp_ns(4));
}

TEST_F(OdometryPredictionTest, TellsALeapFromRoundingBetweenScansAtNearlyTheSameTime) {
  drive(0, 5);
  const std::int64_t soon_ns = stamp_ns(4) + 1000;  // another scanner's
  prediction_.add({soon_ns, wheel_from_odom_ * pose_at(4) * Pose2{0.001, 0.0, 0.0}});
  const Step rounded = prediction_.predict(soon_ns);
  EXPECT_TRUE(rounded.wheels.are_doubted);
  EXPECT_FALSE(rounded.wheels.have_leapt);
  wheel_from_odom_.x_m += 40.0;
  prediction_.add({stamp_ns(5), wheel_from_odom_ * pose_at(5)});
  EXPECT_TRUE(prediction_.predict(stamp_ns(5)).wheels.have_leapt);
}

TEST_F(OdometryPredictionTest, GoesOnAtTheVelocityWhereOdometryJumps) {
  drive(0, 5);
  wheel_from_odom_.x_m += 4.0;
  prediction_.add({stamp_ns(5), wheel_from_odom_ * pose_at(5)});
  const Step step = prediction_.predict(stamp_ns(5));
  EXPECT_EQ(step.source, StepSource::kVelocityThisOnce);
  EXPECT_TRUE(step.wheels.are_doubted);
  EXPECT_THAT(step.after.odom_from_base, PoseNear(pose_at(5), 0.05));
  EXPECT_GT(step.prior().covariance(0, 0), 0.01) << "the match has to decide";
}

TEST_F(OdometryPredictionTest, BelievesAnUnlikelyStepThatIsReportedTwice) {
  drive(0, 5);
  const Pose2 stopped = pose_at(4);
  for (int scan = 5; scan < 7; ++scan)
    prediction_.add({stamp_ns(scan), wheel_from_odom_ * stopped});
  const Step first = prediction_.predict(stamp_ns(5));
  EXPECT_TRUE(first.wheels.are_doubted);
  prediction_.observe(first, without_match(first));
  EXPECT_TRUE(prediction_.predict(stamp_ns(6)).is_by_wheels());
}

TEST_F(OdometryPredictionTest, NeverBelievesAStepFasterThanAnyVehicle) {
  drive(0, 5);
  for (int scan = 5; scan < 8; ++scan) {
    wheel_from_odom_.x_m += 40.0;
    prediction_.add({stamp_ns(scan), wheel_from_odom_ * pose_at(scan)});
    const Step step = prediction_.predict(stamp_ns(scan));
    EXPECT_FALSE(step.is_by_wheels());
    prediction_.observe(step, matched_at(pose_at(scan)));
  }
}

TEST_F(OdometryPredictionTest, TheFirstStepWithoutOdometryMayLeadAnywhereWhereScansAreRare) {
  OdometryPrediction rare{LocalizerConfig{}};
  rare.begin(0);
  EXPECT_EQ(rare.predict(10 * kPeriod_ns).source, StepSource::kReach);
  EXPECT_EQ(rare.predict(kPeriod_ns).source, StepSource::kVelocityAlone);
}

TEST_F(OdometryPredictionTest, GoesOnAtTheVelocityOfTheMatchesWithoutOdometry) {
  prediction_.begin(0);
  for (int scan = 1; scan < 30; ++scan) {
    const Step step = prediction_.predict(stamp_ns(scan));
    ASSERT_EQ(step.source, StepSource::kVelocityAlone);
    if (scan > 20) EXPECT_THAT(step.after.odom_from_base, PoseNear(pose_at(scan), 0.1));
    prediction_.observe(step, matched_at(pose_at(scan)));
  }
}

TEST_F(OdometryPredictionTest, BelievesWheelsThatBeginToCountWhileTheVehicleDrives) {
  for (int scan = 0; scan < 5; ++scan) {
    prediction_.add({stamp_ns(scan), wheel_from_odom_ * pose_at(4)});
    if (scan == 0) prediction_.begin(0);
    else prediction_.observe(prediction_.predict(stamp_ns(scan)), matched_at(Pose2{}));
  }
  for (int scan = 5; scan < 9; ++scan) {
    prediction_.add({stamp_ns(scan), wheel_from_odom_ * pose_at(scan)});
    const Step step = prediction_.predict(stamp_ns(scan));
    EXPECT_EQ(step.wheels.have_begun, scan == 5);
    EXPECT_FALSE(step.wheels.have_changed || step.wheels.are_doubted) << scan;
    EXPECT_EQ(step.source, StepSource::kOdometry);
    EXPECT_EQ(prediction_.explanations(step).size() == 1, scan == 5);
    EXPECT_THAT(step.after.odom_from_base, PoseNear(inverse(pose_at(4)) * pose_at(scan), 0.05));
    prediction_.observe(step, matched_at(inverse(pose_at(4)) * pose_at(scan)));
  }
  wheel_from_odom_.x_m += 0.6;
  prediction_.add({stamp_ns(9), wheel_from_odom_ * pose_at(9)});
  EXPECT_TRUE(prediction_.predict(stamp_ns(9)).wheels.have_changed) << "they have counted before";
}

TEST_F(OdometryPredictionTest, HoldsTheVehicleToStandOnceWheelsHaveStoodForAWhile) {
  drive(0, 1);
  int standing = 0;
  for (int scan = 1; scan < 10; ++scan) {
    prediction_.add({stamp_ns(scan), wheel_from_odom_ * pose_at(0)});
    const Step step = prediction_.predict(stamp_ns(scan));
    standing += step.wheels.is_standing;
    prediction_.observe(step, without_match(step));
  }
  EXPECT_EQ(standing, 4) << "from 0.6 s on";
}

/// Comparisons of scans that contradict odometry until it is no longer believed.
void disbelieve(OdometryPrediction& prediction) {
  const geometry::Matrix3 covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  const Pose2 by_wheels{1.0, 0.0, 0.0};
  for (int i = 0; i < 5; ++i)
    prediction.compare(
        {by_wheels, by_wheels, geometry::UncertainPose2{Pose2{0.0, 0.0, 1.0}, covariance}, 1.0});
  ASSERT_TRUE(prediction.state().belief.is_disbelieved);
}

TEST_F(OdometryPredictionTest, GoesOnFromTheLastPoseWhereOdometryIsNotBelievedAndTimeIsNotKnown) {
  LocalizerConfig config;
  config.odometry.time_is_known = false;
  prediction_ = OdometryPrediction(config);
  drive(0, 30);
  disbelieve(prediction_);
  prediction_.add({stamp_ns(30), wheel_from_odom_ * Pose2{0.0, 0.0, 1.0} * pose_at(30)});
  const Step step = prediction_.predict(stamp_ns(30));
  EXPECT_EQ(step.source, StepSource::kReach);
  EXPECT_TRUE(step.wheels.are_overruled) << "odometry spoke";
  EXPECT_LT((step.after.odom_from_base.translation_m() - pose_at(29).translation_m()).norm(), 1.0);
}

TEST_F(OdometryPredictionTest, TakesAStepFarBeyondTheUsualOnesForAJumpWhereTimeIsNotKnown) {
  LocalizerConfig config;
  config.odometry.time_is_known = false;
  prediction_ = OdometryPrediction(config);
  drive(0, 30);
  wheel_from_odom_ = Pose2{40.0, 0.0, 0.0} * wheel_from_odom_;
  prediction_.add({stamp_ns(30), wheel_from_odom_ * pose_at(30)});
  const Step step = prediction_.predict(stamp_ns(30));
  EXPECT_TRUE(step.wheels.are_doubted);
  EXPECT_LT((step.after.odom_from_base.translation_m() - pose_at(29).translation_m()).norm(), 1.0);
  prediction_.observe(step, matched_at(pose_at(30)));
  prediction_.add({stamp_ns(31), wheel_from_odom_ * pose_at(31)});
  EXPECT_FALSE(prediction_.predict(stamp_ns(31)).wheels.are_doubted);
}

TEST_F(OdometryPredictionTest, GoesOnAtTheVelocityOfTheMatchesWhereOdometryIsNotBelieved) {
  drive(0, 30);
  disbelieve(prediction_);
  prediction_.add({stamp_ns(30), wheel_from_odom_ * pose_at(30)});
  const Step step = prediction_.predict(stamp_ns(30));
  EXPECT_EQ(step.source, StepSource::kVelocityAlone);
  EXPECT_TRUE(step.wheels.are_overruled);
}

TEST_F(OdometryPredictionTest, ExtrapolatesAGapNoFartherThanTheLongestStep) {
  prediction_.begin(0);
  for (int scan = 1; scan < 30; ++scan)
    prediction_.observe(prediction_.predict(stamp_ns(scan)), matched_at(pose_at(scan)));
  const Step step = prediction_.predict(stamp_ns(29) + 10 * 1'000'000'000LL);
  EXPECT_NEAR(step.after.odom_from_base.x_m - pose_at(29).x_m,
              kSpeed_mps * LocalizerConfig{}.odometry.longest_step_s, 1.0);
}

/// It stands at a light for most of the time in which nothing is in range.
TEST_F(OdometryPredictionTest, LearnsNeitherVelocityNorSpacingOfScansFromAGap) {
  constexpr std::int64_t kGap_ns = 40 * kPeriod_ns;
  drive(0, 30);
  const auto later = [&](int scan) { return stamp_ns(scan) + kGap_ns; };
  for (const int scan : {31, 32}) {
    prediction_.add({later(scan), wheel_from_odom_ * pose_at(scan)});
    const Step step = prediction_.predict(later(scan));
    EXPECT_EQ(step.source, StepSource::kOdometry) << "scan " << scan;
    EXPECT_FALSE(step.wheels.are_doubted || step.wheels.have_changed) << "scan " << scan;
    EXPECT_LT(step.usual_duration_s, 2.0 * kPeriod_s) << "scan " << scan;
    prediction_.observe(step, matched_at(pose_at(scan)));
  }
}

TEST_F(OdometryPredictionTest, GoesOnFromAStateAsBefore) {
  drive(0, 5);
  const OdometryPrediction::State state = prediction_.state();
  prediction_.add({stamp_ns(5), wheel_from_odom_ * pose_at(5)});
  const Step step = prediction_.predict(stamp_ns(5));
  prediction_.observe(step, matched_at({2.6, 0.1, 0.01}));
  prediction_.set_state(state);
  EXPECT_EQ(prediction_.predict(stamp_ns(5)).after.odom_from_base, step.after.odom_from_base);
}

TEST_F(OdometryPredictionTest, ResumesWithTheSamplesOfACheckpointAndThoseThatCameSince) {
  drive(0, 5);
  OdometryPrediction since{LocalizerConfig{}};
  since.add({stamp_ns(5), wheel_from_odom_ * pose_at(5)});
  OdometryPrediction resumed{LocalizerConfig{}};
  resumed.resume(prediction_.state(), prediction_.recent_odometry(), std::move(since));
  EXPECT_TRUE(resumed.reaches(stamp_ns(5)));
  prediction_.add({stamp_ns(5), wheel_from_odom_ * pose_at(5)});
  EXPECT_EQ(resumed.predict(stamp_ns(5)).after.odom_from_base,
            prediction_.predict(stamp_ns(5)).after.odom_from_base);
}

/// Seconds of comparisons that disbelieve the wheels until they are recalibrated; none in half a
/// minute.
std::optional<int> seconds_until_recalibrated(
    const std::function<Pose2(const Pose2&, int)>& wheels_of) {
  OdometryPrediction prediction{LocalizerConfig{}};
  prediction.add({0, {}});
  prediction.begin(0);
  const geometry::Matrix3 covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  for (int second = 1; second <= 30; ++second) {
    const Pose2 by_scans{1.0 + 0.3 * (second % 3), 0.0, second % 2 == 0 ? 0.3 : -0.2};
    const Pose2 by_wheels = wheels_of(by_scans, second);
    prediction.compare(
        {by_wheels, by_wheels, geometry::UncertainPose2{by_scans, covariance}, 1.0, 0.0});
    if (prediction.state().belief.recalibrations > 0) return second;
  }
  return std::nullopt;
}

TEST(OdometryPrediction, RecalibratesWheelsThatAreWrongForSecondsWhereFactorsMakeThemRight) {
  const auto counts_too_much = [](const Pose2& step, int) {
    return Pose2{1.4 * step.x_m, step.y_m, step.heading_rad};
  };
  const auto after_s = seconds_until_recalibrated(counts_too_much);
  ASSERT_TRUE(after_s);
  EXPECT_GT(*after_s, 8) << "wheels may slip as long as that";
  EXPECT_LT(*after_s, 20);
}

/// A vehicle that goes straight on at 5 m/s, 40 scans a second; from scan 2000 on its wheels turn
/// by so much and count so much of the way. Error of the last prediction.
Pose2 error_after_wheels_change(double turns_radps, double way_factor) {
  constexpr double kShortPeriod_s = 0.025;
  constexpr double kStep_m = 0.125;
  OdometryPrediction prediction{LocalizerConfig{}};
  Pose2 wheels;
  Pose2 error;
  for (int scan = 0; scan < 2100; ++scan) {
    const std::int64_t stamp_ns = std::int64_t{25'000'000} * scan;
    const Pose2 at{kStep_m * scan, 0.0, 0.0};
    if (scan > 0)
      wheels =
          wheels * (scan < 2000 ? Pose2{kStep_m, 0.0, 0.0}
                                : Pose2{way_factor * kStep_m, 0.0, turns_radps * kShortPeriod_s});
    prediction.add({stamp_ns, wheels});
    if (scan == 0) {
      prediction.begin(0);
      continue;
    }
    const Step step = prediction.predict(stamp_ns);
    error = inverse(at) * step.after.odom_from_base;
    prediction.observe(step, matched_at(at));
  }
  return error;
}

TEST(OdometryPrediction, LearnsAnErrorOfTheWheelsThatComesLater) {
  EXPECT_THAT(error_after_wheels_change(0.0, 1.0), PoseNear(Pose2{}, 1e-4));
  EXPECT_NEAR(error_after_wheels_change(0.1, 1.0).heading_rad, 0.0, 0.1 * 0.0025);
  EXPECT_NEAR(error_after_wheels_change(0.0, 0.9).x_m, 0.0, 0.1 * 0.0125);
}

TEST(OdometryPrediction, DoesNotRecalibrateWheelsThatNoFactorsMakeRight) {
  const auto at_random = [](const Pose2&, int second) {
    return Pose2{0.4 * (second * 7 % 5), 0.0, 0.2 * (second * 3 % 7 - 3)};
  };
  EXPECT_FALSE(seconds_until_recalibrated(at_random));
}

}  // namespace
}  // namespace slammot::localization
