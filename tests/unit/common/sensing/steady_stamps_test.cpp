#include "common/sensing/steady_stamps.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using Stamps = std::vector<std::int64_t>;

constexpr std::int64_t kPeriodNs = 26'666'667;
constexpr std::int64_t kStartNs = 1'100'000'000'000'000'000;  // since 1970

Stamps regular(std::size_t scans) {
  Stamps stamps;
  for (std::size_t i = 0; i < scans; ++i)
    stamps.push_back(kStartNs + kPeriodNs * static_cast<std::int64_t>(i));
  return stamps;
}

Stamps with_noise(Stamps stamps, double sigma_s) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise_s(0.0, sigma_s);
  for (std::int64_t& stamp_ns : stamps) stamp_ns += std::llround(1e9 * noise_s(random));
  return stamps;
}

/// RMS of the error of a step between two scans.
double step_error_s(const Stamps& stamps, const Stamps& times) {
  double squares = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i)
    squares += std::pow(
        1e-9 * static_cast<double>((stamps[i] - stamps[i - 1]) - (times[i] - times[i - 1])), 2);
  return std::sqrt(squares / static_cast<double>(times.size() - 1));
}

TEST(SteadyStamps, LeavesRegularStamps) {
  EXPECT_FALSE(steady_stamps(regular(1'000)));
  EXPECT_FALSE(steady_stamps(with_noise(regular(1'000), 0.0003)));
}

TEST(SteadyStamps, RemovesNoise) {
  for (const double sigma_s : {0.002, 0.005, 0.01}) {
    const Stamps times = regular(1'000);
    const auto steady = steady_stamps(with_noise(times, sigma_s));
    ASSERT_TRUE(steady) << sigma_s;
    EXPECT_NEAR(steady->noise_s, sigma_s, 0.15 * sigma_s);
    EXPECT_NEAR(steady->period_s, 1e-9 * kPeriodNs, 2e-5);
    EXPECT_LT(step_error_s(steady->stamps_ns, times), 0.1 * sigma_s);
  }
}

TEST(SteadyStamps, KeepsMissingScansAndPauses) {
  Stamps times = regular(2'000);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i >= 500) times[i] += kPeriodNs;        // a scan is missing
    if (i >= 1'000) times[i] += 3'000'000'000;  // the log pauses
    if (i >= 1'500) times[i] += 2 * kPeriodNs;
  }
  const auto steady = steady_stamps(with_noise(times, 0.003));
  ASSERT_TRUE(steady);
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR(1e-9 * static_cast<double>(steady->stamps_ns[i] - times[i]), 0.0, 0.004) << i;
}

TEST(SteadyStamps, FollowsAClockThatDrifts) {
  Stamps times = regular(5'000);
  for (std::size_t i = 0; i < times.size(); ++i)
    times[i] += std::llround(2e7 * std::sin(0.002 * static_cast<double>(i)));  // by 20 ms
  const auto steady = steady_stamps(with_noise(times, 0.003));
  ASSERT_TRUE(steady);
  EXPECT_LT(step_error_s(steady->stamps_ns, times), 0.0004);
}

TEST(SteadyStamps, LeavesAScannerThatTurnsUnevenly) {
  std::mt19937 random(5);
  std::normal_distribution<double> uneven_s(0.0, 0.004);
  Stamps times{kStartNs};
  while (times.size() < 2'000)
    times.push_back(times.back() + kPeriodNs + std::llround(1e9 * uneven_s(random)));
  EXPECT_FALSE(steady_stamps(times));
}

TEST(SteadyStamps, SpreadsBatches) {
  const Stamps times = regular(1'000);
  for (const std::size_t size : {2U, 4U, 10U}) {
    Stamps stamps;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const std::size_t last = std::min(times.size() - 1, i / size * size + size - 1);
      stamps.push_back(times[last] + static_cast<std::int64_t>(i % size) * 200'000);
    }
    const auto steady = steady_stamps(stamps);
    ASSERT_TRUE(steady) << size;
    EXPECT_LT(step_error_s(steady->stamps_ns, times), 0.02e-9 * kPeriodNs) << size;
  }
}

TEST(SteadyStamps, LeavesARegularClockWithMissingScans) {
  std::mt19937 random(3);
  std::bernoulli_distribution is_missing(0.1);
  Stamps times;
  for (const std::int64_t time_ns : regular(3'000))
    if (!is_missing(random)) times.push_back(time_ns);
  EXPECT_FALSE(steady_stamps(times));
}

TEST(SteadyStamps, LeavesRegularScansInAnotherOrder) {
  Stamps stamps = regular(1'000);
  for (std::size_t i = 0; i + 3 < stamps.size(); i += 3) std::swap(stamps[i], stamps[i + 2]);
  EXPECT_FALSE(steady_stamps(stamps));
}

TEST(SteadyStamps, LeavesScansThatAreRareOrFew) {
  Stamps rare;
  for (std::int64_t i = 0; i < 500; ++i) rare.push_back(i * 500'000'000);
  EXPECT_FALSE(steady_stamps(with_noise(rare, 0.05)));
  EXPECT_FALSE(steady_stamps(with_noise(regular(100), 0.005)));
}

TEST(SteadyStamps, StampsIncrease) {
  const auto steady = steady_stamps(with_noise(regular(1'000), 0.012));
  ASSERT_TRUE(steady);
  for (std::size_t i = 1; i < steady->stamps_ns.size(); ++i)
    ASSERT_GT(steady->stamps_ns[i], steady->stamps_ns[i - 1]);
}

}  // namespace
}  // namespace slammot::sensing
