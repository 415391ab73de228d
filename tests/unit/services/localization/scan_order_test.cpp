#include "services/localization/scan_order.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using Verdict = ScanOrder::Verdict;

sensing::LaserScan scan_of(const std::string& scanner_id, std::int64_t stamp_ns) {
  sensing::LaserScan scan;
  scan.stamp_ns = stamp_ns;
  scan.scanner.scanner_id = scanner_id;
  return scan;
}

/// Scans as they come, of which the usable ones are accepted.
class ScanOrderTest : public ::testing::Test {
 protected:
  Verdict take(const std::string& scanner_id, double stamp_s) {
    const sensing::LaserScan scan = scan_of(scanner_id, static_cast<std::int64_t>(stamp_s * 1e9));
    const Verdict verdict = order_.judge(scan, last_ns_);
    if (verdict != Verdict::kUsable) return verdict;
    order_.accept(scan, last_ns_);
    last_ns_ = scan.stamp_ns;
    return verdict;
  }

  ScanOrder order_{60.0};
  std::optional<std::int64_t> last_ns_;
};

TEST_F(ScanOrderTest, AcceptsScansOfSeveralScannersAtOneStampOnceEach) {
  EXPECT_EQ(take("front", 1.0), Verdict::kUsable);
  EXPECT_EQ(take("rear", 1.0), Verdict::kUsable);
  EXPECT_EQ(take("front", 1.0), Verdict::kDuplicate);
  EXPECT_EQ(take("rear", 1.0), Verdict::kDuplicate);
}

TEST_F(ScanOrderTest, RefusesAnOlderScan) {
  take("front", 2.0);
  EXPECT_EQ(take("rear", 1.0), Verdict::kOutOfOrder);
}

TEST_F(ScanOrderTest, TakesTheStampOfACheckpointForThatOfAnyScanner) {
  last_ns_ = 1'000'000'000;
  EXPECT_EQ(take("rear", 1.0), Verdict::kDuplicate);
}

TEST_F(ScanOrderTest, AcceptsBlankScansOnceForEachScannerAndStampInAnOrderOfTheirOwn) {
  EXPECT_TRUE(order_.accept_blank(scan_of("front", 100)));
  EXPECT_TRUE(order_.accept_blank(scan_of("rear", 100)));
  EXPECT_FALSE(order_.accept_blank(scan_of("front", 100)));
  EXPECT_TRUE(order_.accept_blank(scan_of("front", 200)));
  EXPECT_FALSE(order_.accept_blank(scan_of("rear", 100)));
}

TEST_F(ScanOrderTest, BelievesAStampFarAheadOnceASecondOneAgrees) {
  take("front", 1.0);
  EXPECT_EQ(take("front", 1000.0), Verdict::kFarAhead);
  EXPECT_EQ(take("front", 1.1), Verdict::kUsable);
  EXPECT_EQ(take("front", 1000.0), Verdict::kFarAhead);
  EXPECT_EQ(take("front", 1000.1), Verdict::kUsable);
}

}  // namespace
}  // namespace slammot::localization
