#include "common/sensing/mean_innovation.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr double kNoiseSigmas = 1.8;

TEST(MeanInnovation, IsNotConsistentOfNoise) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.4);
  MeanInnovation mean;
  for (int scan = 0; scan < 10'000; ++scan) {
    const double sigmas = noise(random);
    mean.add(sigmas, 0.01 * sigmas);
    EXPECT_EQ(mean.take_consistent(kNoiseSigmas), 0.0) << scan;
  }
}

TEST(MeanInnovation, TellsOfAnErrorThatLasts) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.3);
  for (const double lasting : {0.4, 1.0, -2.0}) {
    MeanInnovation mean;
    for (int scan = 0; scan < 200; ++scan) mean.add(noise(random), 0.0);
    double squared_error = 0.0;
    int scans = 0;
    for (; squared_error == 0.0 && scans < 100; ++scans) {
      mean.add(lasting + noise(random), 0.1 * lasting);
      squared_error = mean.take_consistent(kNoiseSigmas);
    }
    EXPECT_LT(scans, 50) << lasting;
    EXPECT_GT(squared_error, 0.0);
    EXPECT_LE(squared_error, 0.01 * lasting * lasting * 1.001);
    EXPECT_EQ(mean.take_consistent(kNoiseSigmas), 0.0) << "it begins anew";
  }
}

TEST(MeanInnovation, IsNotToldByAFewScans) {
  MeanInnovation mean;
  for (int scan = 0; scan < 4; ++scan) {
    mean.add(10.0, 1.0);
    EXPECT_EQ(mean.take_consistent(kNoiseSigmas), 0.0);
  }
  mean.add(10.0, 1.0);
  EXPECT_NEAR(mean.take_consistent(kNoiseSigmas), 1.0, 1e-9);
}

TEST(MeanInnovation, IsNotSoundWithWhatNoFilterSays) {
  MeanInnovation mean;
  EXPECT_TRUE(mean.is_sound());
  mean.add(0.5, -0.1);
  EXPECT_TRUE(mean.is_sound());
  MeanInnovation endless = mean;
  endless.add(0.0, 1e300);
  EXPECT_FALSE(endless.is_sound());
  mean.add(std::numeric_limits<double>::quiet_NaN(), 0.0);
  EXPECT_FALSE(mean.is_sound());
}

}  // namespace
}  // namespace slammot::sensing
