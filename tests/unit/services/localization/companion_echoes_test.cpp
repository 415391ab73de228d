#include "services/localization/companion_echoes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using geometry::Pose2;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Two beams of five end a metre away.
sensing::LaserScan scan(const std::string& scanner_id) {
  sensing::LaserScan scan;
  scan.scanner.scanner_id = scanner_id;
  scan.scanner.first_beam_rad = -0.4;
  scan.scanner.beam_step_rad = 0.2;
  scan.scanner.max_range_m = 30.0;
  scan.range_m = {9.0F, 9.0F, 1.0F, 1.0F, 9.0F};
  return scan;
}

std::vector<std::size_t> after_a_drive(CompanionEchoes& echoes, const std::string& scanner_id,
                                       double step_m) {
  std::vector<std::size_t> beams;
  for (int i = 0; i < 10; ++i)
    beams = echoes.of(scan(scanner_id), Pose2{40.0 + step_m * i, 0.0, 0.0});
  return beams;
}

TEST(CompanionEchoes, AreThoseThatStayWhileOdometryMoves) {
  CompanionEchoes echoes;
  EXPECT_THAT(after_a_drive(echoes, "front", 0.5), ElementsAre(2U, 3U));
  EXPECT_THAT(after_a_drive(echoes, "rear", 0.0), IsEmpty());
  EXPECT_THAT(echoes.of(scan("front"), std::nullopt), ElementsAre(2U, 3U));
}

TEST(CompanionEchoes, AreNotFoundWithoutOdometry) {
  CompanionEchoes echoes;
  for (int i = 0; i < 10; ++i) EXPECT_THAT(echoes.of(scan("front"), std::nullopt), IsEmpty());
}

}  // namespace
}  // namespace slammot::localization
