#include "services/loop_closing/surroundings.hpp"

#include <gtest/gtest.h>

namespace slammot::loop_closing {
namespace {

TEST(Surroundings, OfABuildingAreNarrowerAndMoreExactThanStreetsInEverything) {
  const LoopClosingConfig streets;
  LoopClosingConfig config;
  set_surroundings(config, Surroundings::building);
  EXPECT_EQ(config.surroundings, Surroundings::building);
  EXPECT_LT(config.place.tolerance_m, streets.place.tolerance_m);
  EXPECT_LT(config.revisit.max_window_m, streets.revisit.max_window_m);
  EXPECT_LT(config.revisit.astray_window_m, streets.revisit.astray_window_m);
  EXPECT_LT(config.revisit.registration.fine_gate_m, streets.revisit.registration.fine_gate_m);
  EXPECT_LT(config.revisit.registration.surfel_sigma_m,
            streets.revisit.registration.surfel_sigma_m);
}

TEST(Surroundings, OfStreetsAreTheDefaultsAlsoAfterABuilding) {
  const LoopClosingConfig streets;
  LoopClosingConfig config;
  set_surroundings(config, Surroundings::building);
  set_surroundings(config, Surroundings::streets);
  EXPECT_EQ(config.surroundings, Surroundings::streets);
  EXPECT_EQ(config.place.tolerance_m, streets.place.tolerance_m);
  EXPECT_EQ(config.revisit.max_window_m, streets.revisit.max_window_m);
  EXPECT_EQ(config.revisit.astray_window_m, streets.revisit.astray_window_m);
  EXPECT_EQ(config.revisit.registration.fine_gate_m, streets.revisit.registration.fine_gate_m);
  EXPECT_EQ(config.revisit.registration.surfel_sigma_m,
            streets.revisit.registration.surfel_sigma_m);
}

}  // namespace
}  // namespace slammot::loop_closing
