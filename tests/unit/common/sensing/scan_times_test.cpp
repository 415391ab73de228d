#include "common/sensing/scan_times.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// Times of a scanner that was thinned by way: unevenly apart.
std::vector<std::int64_t> uneven_times_ns(std::size_t scans) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> way_m(0.2, 1.0);
  std::vector<std::int64_t> times{1'000 * kSecond};
  while (times.size() < scans)
    times.push_back(times.back() + std::llround(1e9 * way_m(random) / 0.4));
  return times;
}

std::vector<std::int64_t> steady_times_ns(std::size_t scans, std::int64_t period_ns) {
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < scans; ++i)
    times.push_back(1'000 * kSecond + static_cast<std::int64_t>(i) * period_ns);
  return times;
}

/// Scans of a vehicle that drives 0.4 m/s by these times, with stamps made of them.
std::vector<ScanMark> marks(const std::vector<std::int64_t>& times_ns,
                            const std::function<std::int64_t(std::int64_t)>& stamp_of) {
  std::vector<ScanMark> scans;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    scans.push_back({stamp_of(times_ns[i]),
                     i > 0 ? 0.4e-9 * static_cast<double>(times_ns[i] - times_ns[i - 1]) : 0.0,
                     0.0});
  }
  return scans;
}

/// Largest error of a step between two scans.
double worst_step_error_s(const std::vector<std::int64_t>& stamps_ns,
                          const std::vector<std::int64_t>& times_ns) {
  double worst_s = 0.0;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    worst_s =
        std::max(worst_s, 1e-9 * std::abs(static_cast<double>((stamps_ns[i] - stamps_ns[i - 1]) -
                                                              (times_ns[i] - times_ns[i - 1]))));
  }
  return worst_s;
}

TEST(JudgeScanStamps, KeepsAClockAsItIsRecorded) {
  for (const auto& times_ns : {steady_times_ns(100, kSecond / 10), steady_times_ns(100, 26'667'000),
                               uneven_times_ns(100)}) {
    const ScanTimes times = judge_scan_stamps(marks(times_ns, [](std::int64_t t) { return t; }));
    EXPECT_EQ(times.fault, ClockFault::kNone);
    EXPECT_TRUE(times.is_clock);
    EXPECT_TRUE(times.stamps_ns.empty());
  }
}

TEST(JudgeScanStamps, TakesNoTimeFromStampsThatAreAbsentConstantOrAnIndex) {
  const auto times_ns = steady_times_ns(100, kSecond / 10);
  std::vector<ScanMark> absent(100);
  EXPECT_EQ(judge_scan_stamps(absent).fault, ClockFault::kAbsent);
  EXPECT_EQ(judge_scan_stamps(marks(times_ns, [](std::int64_t) { return 1'134'860'000 * kSecond; }))
                .fault,
            ClockFault::kConstant);
  for (const std::int64_t unit_ns : {kSecond, 3 * kSecond, std::int64_t{1}}) {
    const ScanTimes times = judge_scan_stamps(marks(times_ns, [&](std::int64_t t) {
      return (t - 1'000 * kSecond) / (kSecond / 10) * unit_ns;
    }));
    EXPECT_EQ(times.fault, ClockFault::kIndex);
    EXPECT_FALSE(times.is_clock);
  }
}

TEST(JudgeScanStamps, ConvertsOtherUnits) {
  const auto times_ns = steady_times_ns(100, kSecond / 10);
  for (const std::int64_t units : {1'000, 1'000'000}) {
    const ScanTimes times =
        judge_scan_stamps(marks(times_ns, [&](std::int64_t t) { return t * units; }));
    EXPECT_EQ(times.fault, ClockFault::kUnit);
    EXPECT_NEAR(times.unit_s, 1.0 / static_cast<double>(units), 1e-12);
    ASSERT_EQ(times.stamps_ns.size(), 100u);
    EXPECT_LT(worst_step_error_s(times.stamps_ns, times_ns), 1e-6);
  }
}

/// Numbers that are no whole ones, a fast vehicle, and a robot that logs every five seconds: period
/// and speed decide together.
TEST(JudgeScanStamps, TellsMillisecondsByPeriodAndSpeed) {
  struct Case {
    std::int64_t period_ns;
    double speed_mps;
  };
  for (const auto& [period_ns, speed_mps] :
       {Case{26'666'700, 13.0}, Case{26'666'700, 0.5}, Case{5'243'170'000, 0.17},
        Case{11'370'000'000, 0.3}, Case{100'000'000, 0.0}}) {
    const auto times_ns = steady_times_ns(200, period_ns);
    for (const std::int64_t units : {std::int64_t{1}, std::int64_t{1'000}}) {
      std::vector<ScanMark> scans = marks(times_ns, [&](std::int64_t t) { return t * units; });
      for (ScanMark& scan : scans) scan.way_m *= speed_mps / 0.4;
      const ScanTimes times = judge_scan_stamps(scans);
      EXPECT_DOUBLE_EQ(times.unit_s, 1.0 / static_cast<double>(units))
          << period_ns << " ns, " << speed_mps << " m/s";
    }
  }
}

TEST(JudgeScanStamps, SpreadsWholeSecondsOfASteadyScannerEvenly) {
  const auto times_ns = steady_times_ns(400, 26'667'000);
  const ScanTimes times =
      judge_scan_stamps(marks(times_ns, [](std::int64_t t) { return t / kSecond * kSecond; }));
  EXPECT_EQ(times.fault, ClockFault::kCoarse);
  EXPECT_DOUBLE_EQ(times.quantum_s, 1.0);
  ASSERT_EQ(times.stamps_ns.size(), times_ns.size());
  EXPECT_LT(worst_step_error_s(times.stamps_ns, times_ns), 0.005);
}

TEST(JudgeScanStamps, SpreadsWholeSecondsByTheWayWhereThatIsMoreEven) {
  const auto times_ns = uneven_times_ns(300);
  const ScanTimes times =
      judge_scan_stamps(marks(times_ns, [](std::int64_t t) { return t / kSecond * kSecond; }));
  EXPECT_EQ(times.fault, ClockFault::kCoarse);
  ASSERT_EQ(times.stamps_ns.size(), times_ns.size());
  EXPECT_LT(worst_step_error_s(times.stamps_ns, times_ns), 0.35);  // up to a whole second as
                                                                   // recorded
}

TEST(JudgeScanStamps, KeepsSpreadStampsWithinTheirSecondAndGrowing) {
  const auto times_ns = uneven_times_ns(300);
  const auto scans = marks(times_ns, [](std::int64_t t) { return t / kSecond * kSecond; });
  const ScanTimes times = judge_scan_stamps(scans);
  ASSERT_EQ(times.stamps_ns.size(), scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_GE(times.stamps_ns[i], *scans[i].stamp_ns);
    EXPECT_LE(times.stamps_ns[i], *scans[i].stamp_ns + kSecond + 300'000);
    if (i > 0) EXPECT_GT(times.stamps_ns[i], times.stamps_ns[i - 1]);
  }
}

TEST(JudgeScanStamps, MirrorsAClockThatRunsBackwards) {
  const auto times_ns = uneven_times_ns(100);
  const ScanTimes times =
      judge_scan_stamps(marks(times_ns, [](std::int64_t t) { return 5'000 * kSecond - t; }));
  EXPECT_EQ(times.fault, ClockFault::kBackwards);
  ASSERT_EQ(times.stamps_ns.size(), 100u);
  EXPECT_LT(worst_step_error_s(times.stamps_ns, times_ns), 1e-9);
}

TEST(JudgeScanStamps, BridgesJumpsThatLast) {
  const auto times_ns = steady_times_ns(100, kSecond / 10);
  for (const std::int64_t jump_s : {-7'200, -3, 7'200}) {
    const ScanTimes times = judge_scan_stamps(marks(
        times_ns, [&](std::int64_t t) { return t < 1'005 * kSecond ? t : t + jump_s * kSecond; }));
    EXPECT_EQ(times.fault, ClockFault::kJumps);
    EXPECT_EQ(times.jumps, 1u);
    EXPECT_LT(worst_step_error_s(times.stamps_ns, times_ns), 1e-9);
  }
}

TEST(JudgeScanStamps, LeavesASingleWrongStampToTheReader) {
  const auto times_ns = steady_times_ns(100, kSecond / 10);
  for (const std::int64_t error_s : {-7'200, 7'200}) {
    const ScanTimes times = judge_scan_stamps(marks(
        times_ns, [&](std::int64_t t) { return t == times_ns[50] ? t + error_s * kSecond : t; }));
    EXPECT_EQ(times.fault, ClockFault::kNone);
  }
}

TEST(StampsFromWay, GoNoFasterThanThePace) {
  const std::vector<ScanMark> scans{
      {.way_m = 7.0}, {.way_m = 1.0}, {.turn_rad = 1.5}, {.way_m = 0.001}};
  const auto stamps_ns =
      stamps_from_way(scans, {.least_period_s = 0.1, .speed_mps = 0.5, .turn_rate_radps = 0.5});
  EXPECT_EQ(stamps_ns,
            (std::vector<std::int64_t>{0, 2 * kSecond, 5 * kSecond, 5 * kSecond + kSecond / 10}));
}

TEST(StampsFromWay, HaveAConstantPeriodWhereTheVehicleStandsNowAndThen) {
  std::vector<ScanMark> scans(100);
  for (std::size_t i = 0; i < scans.size(); ++i) scans[i].way_m = i < 20 ? 0.0 : 0.3;
  EXPECT_TRUE(comes_by_time(scans));
  const auto stamps_ns =
      stamps_from_way(scans, {.least_period_s = 0.1, .speed_mps = 0.5, .turn_rate_radps = 0.5});
  for (std::size_t i = 1; i < scans.size(); ++i)
    EXPECT_EQ(stamps_ns[i] - stamps_ns[i - 1], 150'000'000);
}

TEST(StampsFromWay, AreThoseOfAFastScannerWhereWaysAreShort) {
  std::vector<ScanMark> scans(100);
  for (std::size_t i = 20; i < scans.size(); ++i) scans[i].way_m = 0.06;
  const auto stamps_ns =
      stamps_from_way(scans, {.least_period_s = 0.1, .speed_mps = 0.5, .turn_rate_radps = 0.5});
  for (std::size_t i = 1; i < scans.size(); ++i)
    EXPECT_EQ(stamps_ns[i] - stamps_ns[i - 1], 30'000'000);
  for (ScanMark& scan : scans) scan.way_m *= 0.01;
  const auto fastest_ns =
      stamps_from_way(scans, {.least_period_s = 0.1, .speed_mps = 0.5, .turn_rate_radps = 0.5});
  EXPECT_NEAR(1e-9 * static_cast<double>(fastest_ns.back()), 99.0 / 75.0, 1e-6);
}

TEST(MayCountSeconds, OnlyWhereAScanASecondIsADriveAtTheUsualPace) {
  const auto counted = [](double way_m, bool stands) {
    std::vector<ScanMark> scans(100);
    for (std::size_t i = 0; i < scans.size(); ++i)
      scans[i] = {static_cast<std::int64_t>(i + 1) * kSecond, stands && i < 20 ? 0.0 : way_m, 0.0};
    return scans;
  };
  const WayPace walk{.speed_mps = 0.5};
  EXPECT_TRUE(may_count_seconds(counted(0.6, true), walk));
  EXPECT_FALSE(may_count_seconds(counted(0.1, true), walk)) << "five scans a second";
  EXPECT_FALSE(may_count_seconds(counted(0.6, false), walk)) << "a scan every 0.6 m";
  std::vector<ScanMark> nanoseconds = counted(0.6, true);
  for (ScanMark& scan : nanoseconds) *scan.stamp_ns /= kSecond;
  EXPECT_FALSE(may_count_seconds(nanoseconds, walk));
}

TEST(ComesByTime, IsFalseWhereScansWereLeftOutUntilTheVehicleHadMoved) {
  EXPECT_FALSE(comes_by_time(marks(uneven_times_ns(300), [](std::int64_t t) { return t; })));
  EXPECT_FALSE(comes_by_time(std::vector<ScanMark>(100)));
}

TEST(PaceAmong, IsAWalkInRoomsAndADriveInTheOpen) {
  EXPECT_DOUBLE_EQ(pace_among(3.0).speed_mps, 0.5);
  EXPECT_GT(pace_among(20.0).speed_mps, 2.0);
}

}  // namespace
}  // namespace slammot::sensing
