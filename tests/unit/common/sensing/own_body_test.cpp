#include "common/sensing/own_body.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr std::size_t kBeams = 60;
constexpr std::size_t kMastFrom = 20;  // beams of a mast 0.4 m away
constexpr std::size_t kMastTo = 24;

/// Scans of a place that changes with each view, in metres.
class Views {
 public:
  std::vector<float> next(bool has_mast) {
    std::vector<float> readings;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const bool is_mast = has_mast && beam >= kMastFrom && beam < kMastTo;
      readings.push_back(is_mast ? 0.4F + 0.01F * noise_(random_) : 1.0F + 9.0F * place_(random_));
    }
    return readings;
  }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<float> place_{0.0F, 1.0F};
  std::normal_distribution<float> noise_;
};

OwnBody body_after(std::size_t views, bool has_mast = true) {
  OwnBodySurvey survey;
  Views scans;
  for (std::size_t i = 0; i < views; ++i) survey.add(scans.next(has_mast));
  return survey.conclude(1.0);
}

TEST(OwnBody, IsWhatIsAsFarAwayInAllViewsAndTheBeamsBesideIt) {
  const OwnBody body = body_after(1000);
  ASSERT_EQ(body.reach.size(), kBeams);
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const bool is_near_mast = beam + 1 >= kMastFrom && beam <= kMastTo;
    EXPECT_NEAR(body.reach[beam], is_near_mast ? 0.43 : 0.0, 0.01) << beam;
  }
}

TEST(OwnBody, IsNothingWithoutAMastOrWithFewViews) {
  EXPECT_EQ(body_after(1000, false).beams(), 0U);
  EXPECT_EQ(body_after(20).beams(), 0U);
}

TEST(OwnBody, IsNotAWallBesideAVehicleThatStands) {
  OwnBodySurvey survey;
  Views scans;
  const std::vector<float> place = scans.next(false);
  for (int i = 0; i < 1000; ++i) {
    std::vector<float> now = place;
    for (std::size_t beam = 0; beam < kBeams / 4; ++beam)
      now[beam] = 0.5F + 0.01F * static_cast<float>(i % 90);  // somebody walks past
    survey.add(now);
  }
  EXPECT_EQ(survey.conclude(1.0).beams(), 0U);
}

TEST(OwnBody, IsFoundInMillimetres) {
  OwnBodySurvey survey;
  Views scans;
  for (int i = 0; i < 100; ++i) {
    std::vector<float> readings = scans.next(true);
    for (float& reading : readings) reading *= 1000.0F;
    survey.add(readings);
  }
  EXPECT_NEAR(survey.conclude(1e-3).reach[kMastFrom], 430.0, 10.0);
  EXPECT_EQ(survey.conclude(1.0).beams(), 0U) << "400 m away";
}

TEST(OwnBody, HidesItsEchoesOnly) {
  const OwnBody body{{0.43F, 0.43F, 0.0F, 0.43F}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> readings{0.4F, 5.0F, 0.4F, nan};
  body.hide(readings, 0.001F);
  EXPECT_EQ(readings[0], 0.001F);
  EXPECT_EQ(readings[1], 5.0F) << "past it";
  EXPECT_EQ(readings[2], 0.4F) << "another beam";
  EXPECT_TRUE(std::isnan(readings[3]));
  std::vector<float> others{0.4F, 0.4F};
  body.hide(others, 0.001F);
  EXPECT_EQ(others[0], 0.4F) << "a scan of another number of beams";
}

}  // namespace
}  // namespace slammot::sensing
