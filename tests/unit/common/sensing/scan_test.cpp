#include "common/sensing/scan.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

TEST(IsEcho, RefusesWhatNoScannerMeasured) {
  EXPECT_TRUE(is_echo(0.01F, 80.0));
  EXPECT_TRUE(is_echo(79.99F, 80.0));
  EXPECT_FALSE(is_echo(80.0F, 80.0));
  EXPECT_FALSE(is_echo(81.0F, 80.0));
  EXPECT_FALSE(is_echo(0.0F, 80.0));
  EXPECT_FALSE(is_echo(-1.0F, 80.0));
  EXPECT_FALSE(is_echo(std::numeric_limits<float>::quiet_NaN(), 80.0));
  EXPECT_FALSE(is_echo(std::numeric_limits<float>::infinity(), 80.0));
}

TEST(BeamAngle, CountsFromTheFirstBeamEitherWayRound) {
  Scanner scanner{.first_beam_rad = -1.5, .beam_step_rad = 0.5};
  EXPECT_DOUBLE_EQ(beam_angle_rad(scanner, 0), -1.5);
  EXPECT_DOUBLE_EQ(beam_angle_rad(scanner, 6), 1.5);
  scanner.beam_step_rad = -0.5;
  EXPECT_DOUBLE_EQ(beam_angle_rad(scanner, 2), -2.5);
}

TEST(BeamDelay, SpreadsTheSweepFromTheFirstBeamToTheLast) {
  const Scanner scanner{.sweep_s = 0.013};
  EXPECT_DOUBLE_EQ(beam_delay_s(scanner, 0, 361), 0.0);
  EXPECT_DOUBLE_EQ(beam_delay_s(scanner, 180, 361), 0.0065);
  EXPECT_DOUBLE_EQ(beam_delay_s(scanner, 360, 361), 0.013);
}

TEST(BeamDelay, IsNoneForASingleBeam) {
  EXPECT_DOUBLE_EQ(beam_delay_s(Scanner{.sweep_s = 0.013}, 0, 1), 0.0);
}

}  // namespace
}  // namespace slammot::sensing
