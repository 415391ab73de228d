#include "services/tracking/scanners.hpp"

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

flow::SegmentedScan scan_of(const char* scanner_id, std::int64_t stamp_ns) {
  flow::SegmentedScan scan;
  scan.scanner_id = scanner_id;
  scan.stamp_ns = stamp_ns;
  return scan;
}

TEST(Scanners, AreKnownByTheirNamesInTheOrderOfTheirFirstScans) {
  Scanners scanners;
  scanners.begin(scan_of("front", 1));
  scanners.begin(scan_of("rear", 2));
  EXPECT_EQ(scanners.current_index(), 1U);
  scanners.begin(scan_of("front", 3));
  EXPECT_EQ(scanners.current_index(), 0U);
  EXPECT_EQ(scanners.count(), 2U);
  EXPECT_EQ(scanners.current().scanner_id, "front");
}

TEST(Scanners, TellTheTimeSinceTheLastScanOfAny) {
  Scanners scanners;
  EXPECT_EQ(scanners.begin(scan_of("front", 1'000'000'000)), 0.0);
  EXPECT_DOUBLE_EQ(scanners.begin(scan_of("rear", 1'020'000'000)), 0.02);
  EXPECT_DOUBLE_EQ(scanners.begin(scan_of("front", 1'020'000'000)), 0.0);
}

TEST(Scanners, TakeAnOlderScanForLateAndASecondOneOfTheSameStampFromAnotherNot) {
  Scanners scanners;
  EXPECT_FALSE(scanners.is_late(scan_of("front", 5)));
  scanners.begin(scan_of("front", 5));
  EXPECT_TRUE(scanners.is_late(scan_of("rear", 4)));
  EXPECT_TRUE(scanners.is_late(scan_of("front", 5)));
  EXPECT_FALSE(scanners.is_late(scan_of("rear", 5)));
  EXPECT_FALSE(scanners.is_late(scan_of("front", 6)));
}

TEST(Scanners, AreForgottenButForTheTimeOnReset) {
  Scanners scanners;
  scanners.begin(scan_of("front", 5));
  scanners.reset(1'000'000'000);
  EXPECT_EQ(scanners.count(), 0U);
  EXPECT_TRUE(scanners.is_late(scan_of("front", 1'000'000'000)))
      << "who had the last stamp is not known";
  EXPECT_DOUBLE_EQ(scanners.begin(scan_of("front", 1'500'000'000)), 0.5);
}

}  // namespace
}  // namespace slammot::tracking
