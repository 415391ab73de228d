#include "services/ingest/log_source.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/ingest/small_log.hpp"

namespace slammot::ingest {
namespace {

TEST(LogSource, ReturnsEachScanWithTheOdometryBeforeIt) {
  const slammot::testing::TemporaryFolder folder;
  write_small_log(folder / "drive.log", 20);
  IngestConfig config;
  config.scanner_id = "rear";
  config.sweep_s = 0.02;
  auto source = LogSource::open(folder / "drive.log", config);
  ASSERT_TRUE(source);
  std::uint32_t scans = 0;
  while (const auto step = source->next()) {
    ASSERT_TRUE(step->scan);
    ASSERT_FALSE(step->odometry.empty());
    EXPECT_EQ(step->odometry.back().stamp_ns, step->scan->stamp_ns);
    EXPECT_EQ(step->scan->scanner.scanner_id, "rear");
    EXPECT_EQ(step->scan->scanner.sweep_s, 0.02);
    EXPECT_EQ(step->scan->sequence, scans++);
  }
  EXPECT_EQ(scans, 20U);
}

TEST(LogSource, ReportsWhyALogCannotBePlayed) {
  const auto source = LogSource::open("/nowhere/drive.log", {});
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().message.find("/nowhere/drive.log"), std::string::npos);
}

}  // namespace
}  // namespace slammot::ingest
