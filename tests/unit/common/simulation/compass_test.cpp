#include "common/simulation/compass.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

TEST(Compass, ErrsAsMuchAsItSays) {
  double square_rad2 = 0.0;
  double sigma_rad = 0.0;
  constexpr int kDrives = 3000;
  for (int seed = 0; seed < kDrives; ++seed) {
    const auto reading =
        Compass({}, static_cast<std::uint64_t>(seed)).reading({0.0, 0.0, 3.1}, 4.0);
    square_rad2 += std::pow(geometry::wrap_angle(reading.heading_from_east_rad - 3.1), 2);
    sigma_rad = reading.sigma_rad;
  }
  EXPECT_NEAR(std::sqrt(square_rad2 / kDrives), sigma_rad, 0.05 * sigma_rad);
}

TEST(Compass, IsBentByTheSameIronWhereItStands) {
  CompassConfig config;
  config.noise_rad = 0.0;
  Compass compass(config, 1);
  const double first_rad = compass.reading({}, 0.0).heading_from_east_rad;
  EXPECT_EQ(compass.reading({}, 0.0).heading_from_east_rad, first_rad);
  EXPECT_NE(compass.reading({}, 30.0).heading_from_east_rad, first_rad);
}

}  // namespace
}  // namespace slammot::simulation
