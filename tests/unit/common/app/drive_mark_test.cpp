#include "common/app/drive_mark.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace slammot::app {
namespace {

/// Writes the file that a killed process leaves.
void leave_mark(const std::filesystem::path& file, const std::string& log, std::uint64_t drive_id) {
  std::ofstream(file) << log << '\n' << drive_id << '\n';
}

struct DriveMarkTest : ::testing::Test {
  slammot::testing::TemporaryFolder folder;
  std::filesystem::path file = folder / "state/ingest.drive";
};

TEST_F(DriveMarkTest, BeginsANewDriveWithoutAFile) {
  EXPECT_EQ(DriveMark(file, "a.log", 7).drive_id(), 7U);
}

TEST_F(DriveMarkTest, ContinuesTheDriveOfAKilledProcess) {
  std::filesystem::create_directories(file.parent_path());
  leave_mark(file, "a.log", 7);
  EXPECT_EQ(DriveMark(file, "a.log", 8).drive_id(), 7U);
}

TEST_F(DriveMarkTest, TellsHowFarTheKilledProcessWas) {
  DriveMark killed(file, "a.log", 7);
  EXPECT_EQ(killed.noted_ns(), std::nullopt);
  killed.note(17);
  killed.note(18);
  const DriveMark next(file, "a.log", 8);
  EXPECT_EQ(next.drive_id(), 7U);
  EXPECT_EQ(next.noted_ns(), 18);
  EXPECT_EQ(DriveMark(file, "a.log", 9).noted_ns(), 18) << "it was killed before it went on";
  EXPECT_EQ(DriveMark(file, "b.log", 9).noted_ns(), std::nullopt);
}

TEST_F(DriveMarkTest, BeginsANewDriveForAnotherLog) {
  std::filesystem::create_directories(file.parent_path());
  leave_mark(file, "a.log", 7);
  EXPECT_EQ(DriveMark(file, "b.log", 8).drive_id(), 8U);
}

TEST_F(DriveMarkTest, BeginsANewDriveAfterOneThatEnded) {
  { const DriveMark ended(file, "a.log", 7); }
  EXPECT_EQ(DriveMark(file, "a.log", 8).drive_id(), 8U);
}

TEST_F(DriveMarkTest, BeginsANewDriveWithADamagedFile) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "a.log\nseven\n";
  EXPECT_EQ(DriveMark(file, "a.log", 8).drive_id(), 8U);
}

TEST_F(DriveMarkTest, WorksWithoutAWritableFolder) {
  EXPECT_EQ(DriveMark("/proc/no/ingest.drive", "a.log", 7).drive_id(), 7U);
}

}  // namespace
}  // namespace slammot::app
