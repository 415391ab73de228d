#include "common/metrics/gospa.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::metrics {
namespace {

TEST(Gospa, SplitsIntoLocalizationMissedAndFalse) {
  Eigen::MatrixXd distance_m(2, 2);  // the second object and the second track are far from
                                     // everything
  distance_m << 1.0, 50.0, 50.0, 50.0;
  const Gospa result = gospa(distance_m, 4.0);
  EXPECT_DOUBLE_EQ(result.localization_m2, 1.0);
  EXPECT_DOUBLE_EQ(result.missed_m2, 8.0);
  EXPECT_DOUBLE_EQ(result.false_tracks_m2, 8.0);
  EXPECT_DOUBLE_EQ(result.distance_m, std::sqrt(17.0));
}

TEST(Gospa, TakesTheCheapestPairingAndNotTheNearestFirst) {
  Eigen::MatrixXd distance_m(2, 2);
  distance_m << 0.0, 1.0, 1.0, 3.9;
  EXPECT_DOUBLE_EQ(gospa(distance_m, 4.0).localization_m2, 2.0);
}

TEST(Gospa, OfNothingIsNothing) { EXPECT_EQ(gospa(Eigen::MatrixXd(0, 0), 4.0).distance_m, 0.0); }

TEST(Gospa, OfTracksWithoutObjectsIsAllFalse) {
  EXPECT_DOUBLE_EQ(gospa(Eigen::MatrixXd(0, 3), 2.0).false_tracks_m2, 6.0);
}

}  // namespace
}  // namespace slammot::metrics
