#include "common/files/run_journal.hpp"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/values.hpp"

namespace slammot::files {
namespace {

struct RunJournalTest : ::testing::Test {
  slammot::testing::TemporaryFolder folder;
  std::filesystem::path file = folder / "journal";
  slammot::testing::Random random{1};
  flow::LocalizedScan localized = slammot::testing::localized_scan(random, 0);
  flow::TrackedObjects tracked = slammot::testing::tracked_objects(random, 4);

  void write_three_lines() {
    RunJournal journal(file);
    journal.begin({{7}, {70}}, std::array{DriveName{{7}, {69}}});
    journal.add(JournalScan{"front", 3, 41, 1'700'000'000'123'456'789});
    journal.add(localized);
    journal.add(tracked);
  }
};

TEST_F(RunJournalTest, GivesBackTheRowsThatWereWritten) {
  write_three_lines();
  const auto content = RunJournal::read(file);
  ASSERT_TRUE(content);
  EXPECT_EQ(content->drive, (DriveName{{7}, {70}}));
  EXPECT_EQ(content->ended, (std::vector{DriveName{{7}, {69}}}));
  ASSERT_EQ(content->scans.size(), 1U);
  EXPECT_EQ(content->scans.front().scanner_id, "front");
  EXPECT_EQ(content->scans.front().stamp_ns, 1'700'000'000'123'456'789);
  RunRecord before, after;
  before.add_scan(localized.stamp_ns);
  before.add(localized);
  before.add(tracked);
  after.add_scan(localized.stamp_ns);
  after.add(content->localized_scans.at(0));
  after.add(content->tracked_objects.at(0));
  EXPECT_EQ(before.online_trajectory().front().map_from_base,
            after.online_trajectory().front().map_from_base);
  ASSERT_EQ(before.track_rows().size(), after.track_rows().size());
  for (std::size_t i = 0; i < before.track_rows().size(); ++i) {
    const TrackRow a = *before.track_rows()[i], b = *after.track_rows()[i];
    EXPECT_EQ(a.track_id, b.track_id);
    EXPECT_EQ(a.map_from_object, b.map_from_object);
    EXPECT_EQ(a.velocity_in_map_mps, b.velocity_in_map_mps);
    EXPECT_EQ(a.length_m, b.length_m);
    EXPECT_EQ(a.width_m, b.width_m);
    EXPECT_EQ(a.motion, b.motion);
    EXPECT_EQ(a.existence, b.existence);
    EXPECT_EQ(a.object_class, b.object_class);
  }
}

TEST_F(RunJournalTest, LeavesOutALineThatWasBeingWritten) {
  write_three_lines();
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 10);
  const auto content = RunJournal::read(file);
  ASSERT_TRUE(content);
  EXPECT_EQ(content->localized_scans.size(), 1U);
  EXPECT_TRUE(content->tracked_objects.empty());
}

TEST_F(RunJournalTest, GoesOnWhereItWasResumed) {
  write_three_lines();
  RunJournal journal(file);
  journal.resume();
  journal.add(localized);
  EXPECT_EQ(RunJournal::read(file)->localized_scans.size(), 2U);
}

TEST_F(RunJournalTest, GoesOnBehindALineThatWasBeingWritten) {
  write_three_lines();
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 10);
  RunJournal journal(file);
  journal.resume();
  journal.add(localized);
  EXPECT_EQ(RunJournal::read(file)->localized_scans.size(), 2U);
  EXPECT_TRUE(RunJournal::read(file)->tracked_objects.empty());
}

TEST_F(RunJournalTest, ForgetsAnEarlierMap) {
  write_three_lines();
  RunJournal journal(file);
  journal.begin({{8}, {80}});
  EXPECT_EQ(RunJournal::read(file)->drive.map_id, flow::MapId{8});
  EXPECT_TRUE(RunJournal::read(file)->scans.empty());
}

TEST_F(RunJournalTest, IsGoneWhenTheWorkIsDone) {
  write_three_lines();
  RunJournal(file).remove();
  EXPECT_FALSE(RunJournal::read(file));
}

}  // namespace
}  // namespace slammot::files
