// Real logs, where they are: ../shared/data beside the source tree. Skipped elsewhere.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "common/files/carmen_log.hpp"
#include "common/files/log_profile.hpp"

namespace slammot::files {
namespace {

struct RecordedLog {
  const char* file;
  std::uint64_t scans;
  std::size_t beams;
  double max_range_m;
  double laser_ahead_m;
  LogClock clock;
  const char* profile;
};

/// Names the test.
void PrintTo(const RecordedLog& log, std::ostream* to) { *to << log.file; }

class RecordedLogs : public ::testing::TestWithParam<RecordedLog> {};

TEST_P(RecordedLogs, AreUnderstoodWithoutBeingToldAnything) {
  const RecordedLog& expected = GetParam();
  const auto path = std::filesystem::path(SLAMMOT_SOURCE_DIR) / "../shared/data" / expected.file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no recorded data beside the source tree";
  auto log = CarmenLog::open(path);
  ASSERT_TRUE(log) << log.error().message;
  std::uint64_t scans = 0;
  while (const auto event = log->next())
    scans += std::holds_alternative<sensing::LaserScan>(*event) ? 1 : 0;
  EXPECT_EQ(scans, expected.scans);
  EXPECT_EQ(log->plan().figures.beams, expected.beams);
  EXPECT_NEAR(log->plan().max_range_m, expected.max_range_m, 1e-5);
  EXPECT_NEAR(log->plan().base_from_laser.x_m, expected.laser_ahead_m, 1e-6);
  EXPECT_EQ(log->plan().clock, expected.clock);
  EXPECT_EQ(log->faults().malformed_lines, 0u);
  EXPECT_EQ(choose_profile(log->plan().figures).profile, expected.profile);
}

INSTANTIATE_TEST_SUITE_P(
    All, RecordedLogs,
    ::testing::Values(
        RecordedLog{"carmen/intel.rawodom.log.gz", 910, 180, 81.83, 0.0, LogClock::kIpc, "indoor"},
        RecordedLog{"carmen/aces.rawodom.log.gz", 440, 180, 50.0, 0.0, LogClock::kIpc, "indoor"},
        RecordedLog{"carmen/freiburg-101.rawodom.log.gz", 292, 360, 81.91, 0.0, LogClock::kIpc,
                    "indoor"},
        RecordedLog{"intel_raw/intel.carmen.log.gz", 2726, 180, 81.83, 0.0, LogClock::kNominal,
                    "indoor"},
        RecordedLog{"city/city.log.gz", 11536, 361, 81.83, 2.15, LogClock::kIpc, "urban"},
        RecordedLog{"city/quiet.log.gz", 16523, 361, 81.83, 2.15, LogClock::kIpc, "urban"},
        RecordedLog{"datmo_carmen/parallel.log.gz", 218, 360, 16.0, -0.12, LogClock::kIpc,
                    "indoor"},
        RecordedLog{"datmo_carmen/overtakes.log.gz", 337, 360, 16.0, -0.12, LogClock::kIpc,
                    "indoor"}));

}  // namespace
}  // namespace slammot::files
