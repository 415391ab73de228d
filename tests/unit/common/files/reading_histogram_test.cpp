#include "common/files/reading_histogram.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

TEST(ReadingHistogram, HasQuantilesOfTheEchoesAlone) {
  ReadingHistogram readings;
  readings.add(std::vector{1.0F, 2.0F, 3.0F, 81.9F, 81.9F, 81.9F});
  EXPECT_DOUBLE_EQ(readings.range_quantile_m(80.0, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(readings.range_quantile_m(80.0, 0.9), 3.0);
  EXPECT_DOUBLE_EQ(readings.echo_share(80.0), 0.5);
}

TEST(ReadingHistogram, TakesTheSmallestRepeatedReadingAtTheFarEndForNoEcho) {
  ReadingHistogram readings;
  for (int i = 0; i < 10; ++i) readings.add(std::vector{4.0F, 81.83F, 81.91F});
  EXPECT_FLOAT_EQ(static_cast<float>(readings.max_range_m(0.0)), 81.83F);
  EXPECT_EQ(readings.max_range_m(30.0), 30.0);
}

TEST(ReadingHistogram, TakesReadingsForEchoesWhereTheFarthestDoesNotRepeat) {
  ReadingHistogram readings;
  for (int i = 0; i < 10; ++i) readings.add(std::vector{4.0F});
  readings.add(std::vector{20.0F});
  EXPECT_NEAR(readings.max_range_m(0.0), 20.01, 1e-9);
  EXPECT_EQ(readings.max_range_m(50.0), 50.0);
}

TEST(ReadingHistogram, RefutesAMaximumThatManyDifferentReadingsExceed) {
  ReadingHistogram readings;
  for (int i = 0; i < 100; ++i)
    readings.add(std::vector{4.0F, 10.0F + 0.3F * static_cast<float>(i), 81.83F, 81.91F});
  EXPECT_TRUE(readings.refutes(8.0));
  EXPECT_TRUE(readings.refutes(0.001));
  EXPECT_FALSE(readings.refutes(0.0));
  EXPECT_FALSE(readings.refutes(41.0)) << "above it are codes for no echo alone";
}

TEST(ReadingHistogram, CountsReadingsInAnotherUnitAgain) {
  ReadingHistogram readings;
  readings.add(std::vector{1000.0F, 2000.0F, 3000.0F});
  EXPECT_EQ(readings.recorded_quantile(0.5), 2000.0);
  readings.recount(1e-3);
  EXPECT_NEAR(readings.range_quantile_m(10.0, 0.5), 2.0, 1e-9);
}

TEST(ReadingHistogram, CountsBlankScans) {
  ReadingHistogram readings;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  readings.add(std::vector{0.0F, kInfinity, std::numeric_limits<float>::quiet_NaN()});
  readings.add(std::vector{0.0F, 1.0F});
  EXPECT_EQ(readings.scans_without_readings(), 1U);
}

TEST(ReadingHistogram, KnowsNothingWithoutReadings) {
  const ReadingHistogram readings;
  EXPECT_EQ(readings.range_quantile_m(80.0, 0.5), 0.0);
  EXPECT_EQ(readings.recorded_quantile(0.5), 0.0);
  EXPECT_EQ(readings.echo_share(80.0), 0.0);
  EXPECT_EQ(readings.max_range_m(0.0), 1.0);
}

}  // namespace
}  // namespace slammot::files
