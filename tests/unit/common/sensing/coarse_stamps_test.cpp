#include "common/sensing/coarse_stamps.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kPeriodNs = 230'000'000;

std::vector<std::int64_t> stamps_rounded_to(std::int64_t quantum_ns) {
  std::vector<std::int64_t> stamps_ns;
  for (std::int64_t i = 0; i < 200; ++i)
    stamps_ns.push_back(i * kPeriodNs / quantum_ns * quantum_ns);
  return stamps_ns;
}

TEST(SpreadIfCoarse, SpreadsWholeSecondsEvenly) {
  const std::vector<ScanMark> scans(200);
  const auto spread = spread_if_coarse(scans, stamps_rounded_to(kSecondNs));
  ASSERT_TRUE(spread);
  EXPECT_EQ(spread->quantum_s, 1.0);
  for (std::size_t i = 20; i + 20 < spread->stamps_ns.size(); ++i)
    EXPECT_LT(std::abs(spread->stamps_ns[i + 1] - spread->stamps_ns[i] - kPeriodNs), kPeriodNs / 5);
}

TEST(SpreadIfCoarse, LeavesStampsWhoseStepsMeasureTheTime) {
  const std::vector<ScanMark> scans(200);
  EXPECT_FALSE(spread_if_coarse(scans, stamps_rounded_to(kSecondNs / 100)));
  EXPECT_FALSE(spread_if_coarse(scans, stamps_rounded_to(1)));
}

}  // namespace
}  // namespace slammot::sensing
