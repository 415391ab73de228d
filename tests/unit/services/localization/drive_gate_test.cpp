#include "services/localization/drive_gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriodNs = 25 * kMs;

WaitingScan scan_of(std::uint64_t drive_id, std::int64_t stamp_ns,
                    const std::string& scanner_id = "front") {
  WaitingScan scan{{}, drive_id};
  scan.scan.stamp_ns = stamp_ns;
  scan.scan.scanner.scanner_id = scanner_id;
  return scan;
}

/// Feeds a gate, and keeps what comes out of it.
struct Gate {
  DriveGate gate;
  std::int64_t now_ns = 1'000 * kMs;
  std::vector<std::pair<std::uint64_t, std::int64_t>> admitted;  ///< Drives and stamps.
  std::size_t strays = 0;
  int begun = 0;

  void note(const DriveGate::Verdict& verdict) {
    for (const WaitingScan& scan : verdict.admitted)
      admitted.emplace_back(scan.drive_id, scan.scan.stamp_ns);
    strays += verdict.strays.size();
    begun += verdict.begins_drive ? 1 : 0;
  }
  void send(const WaitingScan& scan) { note(gate.judge(scan, now_ns)); }
  void pass_time(std::int64_t duration_ns) {
    for (const std::int64_t end_ns = now_ns + duration_ns; now_ns < end_ns; now_ns += 10 * kMs)
      note(gate.judge_held(now_ns));
  }
  /// Stamps count from 0 for each drive.
  void drive(std::uint64_t drive_id, int first, int end) {
    for (int i = first; i < end; ++i, now_ns += kPeriodNs) send(scan_of(drive_id, i));
  }
  std::size_t admitted_of(std::uint64_t drive_id) const {
    return static_cast<std::size_t>(
        std::ranges::count(admitted, drive_id, [](const auto& scan) { return scan.first; }));
  }
};

TEST(DriveGate, PassesTheScansOfOneDriveAtOnce) {
  Gate gate;
  gate.drive(1, 0, 10);
  EXPECT_EQ(gate.admitted.size(), 10U);
  EXPECT_EQ(gate.begun, 0);
}

TEST(DriveGate, CountsAStrayScanWhileTheDriveGoesOn) {
  Gate gate;
  gate.drive(1, 0, 20);
  gate.send(scan_of(99, 7));
  gate.drive(1, 20, 120);
  EXPECT_EQ(gate.admitted_of(1), 120U);
  EXPECT_EQ(gate.admitted_of(99), 0U);
  EXPECT_EQ(gate.strays, 1U);
  EXPECT_FALSE(gate.gate.holds());
}

TEST(DriveGate, NeverLetsASecondSourceInWhileTheFirstGoesOn) {
  Gate gate;
  gate.drive(1, 0, 20);
  for (int i = 0; i < 400; ++i, gate.now_ns += kPeriodNs) {
    gate.send(scan_of(1, 20 + i));
    gate.send(scan_of(2, i));
  }
  EXPECT_EQ(gate.admitted_of(1), 420U);
  EXPECT_EQ(gate.admitted_of(2), 0U);
  EXPECT_GT(gate.strays, 300U);
}

TEST(DriveGate, BeginsANewDriveAtItsSecondScanWhereTheOneBeforeHasEnded) {
  Gate gate;
  gate.drive(1, 0, 20);
  gate.pass_time(2'000 * kMs);
  gate.drive(2, 0, 2);
  EXPECT_EQ(gate.admitted_of(2), 2U);
  EXPECT_EQ(gate.begun, 1);
}

TEST(DriveGate, BeginsANewDriveThatFollowsAtOnceWithinASecondAndLosesNoScan) {
  Gate gate;
  gate.drive(1, 0, 20);
  const std::int64_t start_ns = gate.now_ns;
  int sent = 0;
  for (; gate.begun == 0 && sent < 100; ++sent) gate.drive(2, sent, sent + 1);
  EXPECT_LT(gate.now_ns - start_ns, 1'000 * kMs);
  EXPECT_EQ(gate.admitted_of(2), static_cast<std::size_t>(sent));
  EXPECT_EQ(gate.admitted.back().second, sent - 1) << "in the order of arrival";
}

TEST(DriveGate, BeginsADriveWhoseSourceAwaitsAnAnswerToItsFirstScan) {
  Gate gate;
  gate.drive(1, 0, 20);
  gate.send(scan_of(2, 0));
  gate.pass_time(1'000 * kMs);
  EXPECT_EQ(gate.admitted_of(2), 1U);
}

TEST(DriveGate, GivesTheDriveBackToTheOneThatGoesOnAfterAStrayInItsSilence) {
  Gate gate;
  gate.drive(1, 0, 20);
  gate.pass_time(5'000 * kMs);
  gate.send(scan_of(99, 0));
  gate.pass_time(1'500 * kMs);
  EXPECT_EQ(gate.admitted_of(99), 1U);
  const std::int64_t start_ns = gate.now_ns;
  gate.drive(1, 20, 24);
  EXPECT_EQ(gate.admitted_of(1), 24U);
  EXPECT_LT(gate.now_ns - start_ns, 1'000 * kMs);
}

TEST(DriveGate, ReleasesTheScansOfSeveralScannersInTheOrderOfArrival) {
  Gate gate;
  for (int i = 0; i < 20; ++i, gate.now_ns += kPeriodNs) {
    gate.send(scan_of(1, 2 * i, "front"));
    gate.send(scan_of(5, 2 * i + 1, "rear"));
  }
  gate.admitted.clear();
  for (int i = 0; i < 40; ++i, gate.now_ns += kPeriodNs) {
    gate.send(scan_of(2, 2 * i, "front"));
    gate.send(scan_of(6, 2 * i + 1, "rear"));
  }
  ASSERT_EQ(gate.admitted.size(), 80U);
  for (int i = 0; i < 80; ++i) EXPECT_EQ(gate.admitted[static_cast<std::size_t>(i)].second, i);
}

TEST(DriveGate, IsPatientWithARareScanner) {
  Gate gate;
  for (int i = 0; i < 10; ++i) {
    gate.send(scan_of(1, i));
    gate.pass_time(1'000 * kMs);
  }
  gate.send(scan_of(99, 0));
  gate.pass_time(900 * kMs);
  gate.send(scan_of(1, 10));
  EXPECT_EQ(gate.admitted_of(1), 11U);
  EXPECT_EQ(gate.admitted_of(99), 0U);
}

TEST(DriveGate, HoldsLittleOfASourceThatNamesAnotherDriveWithEachScan) {
  Gate gate;
  gate.drive(1, 0, 20);
  for (int i = 0; i < 1000; ++i, gate.now_ns += kMs) {
    gate.send(scan_of(100 + static_cast<std::uint64_t>(i), i));
    if (i % 25 == 0) gate.send(scan_of(1, 20 + i));
  }
  EXPECT_EQ(gate.admitted_of(1), 60U);
  EXPECT_EQ(gate.admitted.size(), 60U);
  EXPECT_GE(gate.strays, 990U);
}

}  // namespace
}  // namespace slammot::localization
