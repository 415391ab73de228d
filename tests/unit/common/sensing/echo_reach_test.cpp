#include "common/sensing/echo_reach.hpp"

#include <limits>
#include <utility>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr double kStated_m = 80.0;

LaserScan scan_of(std::string scanner_id, std::vector<float> range_m) {
  LaserScan scan;
  scan.scanner.scanner_id = std::move(scanner_id);
  scan.scanner.max_range_m = kStated_m;
  scan.range_m = std::move(range_m);
  return scan;
}

TEST(EchoReach, IsThatOfTheThirdFarthestEcho) {
  EchoReach reach;
  reach.add(scan_of("front", {7.0F, 3.0F, 8.0F, 5.0F, 60.0F, 6.0F}));
  EXPECT_DOUBLE_EQ(reach.reach_m("front"), 7.0) << "60 m is one reflector, or false";
}

TEST(EchoReach, CountsNothingThatIsNoEcho) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EchoReach reach;
  reach.add(scan_of("front", {kNaN, kInfinity, 80.0F, 81.9F, -1.0F, 0.0F, kNaN, 4.0F, 4.0F, 4.0F}));
  EXPECT_DOUBLE_EQ(reach.reach_m("front"), 4.0);
}

TEST(EchoReach, GrowsAndDoesNotShrink) {
  EchoReach reach;
  EXPECT_DOUBLE_EQ(reach.reach_m("front"), 0.0);
  reach.add(scan_of("front", {5.0F, 5.0F}));
  EXPECT_DOUBLE_EQ(reach.reach_m("front"), 0.0) << "two echoes are few";
  reach.add(scan_of("front", {5.0F, 5.0F, 5.0F}));
  reach.add(scan_of("front", {30.0F, 30.0F, 30.0F}));
  reach.add(scan_of("front", {}));
  reach.add(scan_of("front", {6.0F, 6.0F, 6.0F}));
  EXPECT_DOUBLE_EQ(reach.reach_m("front"), 30.0);
}

TEST(EchoReach, IsOfEachScanner) {
  EchoReach reach;
  reach.add(scan_of("front", {30.0F, 30.0F, 30.0F}));
  reach.add(scan_of("rear", {8.0F, 8.0F, 8.0F}));
  EXPECT_DOUBLE_EQ(reach.reach_m("front"), 30.0);
  EXPECT_DOUBLE_EQ(reach.reach_m("rear"), 8.0);
  EXPECT_DOUBLE_EQ(reach.reach_m("left"), 0.0);
}

}  // namespace
}  // namespace slammot::sensing
