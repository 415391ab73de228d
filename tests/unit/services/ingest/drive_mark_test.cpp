#include "services/ingest/drive_mark.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace slammot::ingest {
namespace {

/// As a process leaves it that was killed.
void leave_mark(const std::filesystem::path& file, const std::string& log, std::uint64_t drive_id) {
  std::ofstream(file) << log << '\n' << drive_id << '\n';
}

struct DriveMarkTest : ::testing::Test {
  slammot::testing::TemporaryFolder folder;
  std::filesystem::path file = folder / "state/ingest.drive";
};

TEST_F(DriveMarkTest, BeginsANewDriveWhereNoneIsNoted) {
  EXPECT_EQ(DriveMark(file, "a.log", 7).drive_id(), 7U);
}

TEST_F(DriveMarkTest, GoesOnWithTheDriveOfAProcessThatWasKilled) {
  std::filesystem::create_directories(file.parent_path());
  leave_mark(file, "a.log", 7);
  EXPECT_EQ(DriveMark(file, "a.log", 8).drive_id(), 7U);
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

TEST_F(DriveMarkTest, BeginsANewDriveWhereTheMarkIsDamaged) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "a.log\nseven\n";
  EXPECT_EQ(DriveMark(file, "a.log", 8).drive_id(), 8U);
}

TEST_F(DriveMarkTest, DoesWithoutAFolderItCanWrite) {
  EXPECT_EQ(DriveMark("/proc/no/ingest.drive", "a.log", 7).drive_id(), 7U);
}

}  // namespace
}  // namespace slammot::ingest
