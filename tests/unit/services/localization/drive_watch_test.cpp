#include "services/localization/drive_watch.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using Scan = DriveWatch::Scan;

TEST(DriveWatch, StaysInADriveThatKeepsItsName) {
  DriveWatch watch;
  EXPECT_EQ(watch.judge("front", 1), Scan::kOfThisDrive);
  EXPECT_EQ(watch.judge("front", 1), Scan::kOfThisDrive);
}

TEST(DriveWatch, BeginsANewOneWhereAScannerNamesAnother) {
  DriveWatch watch;
  watch.judge("front", 1);
  EXPECT_EQ(watch.judge("front", 2), Scan::kOfNewDrive);
  EXPECT_EQ(watch.judge("front", 2), Scan::kOfThisDrive);
}

TEST(DriveWatch, LetsEveryScannerNameItsDriveItself) {
  DriveWatch watch;
  watch.judge("front", 1);
  EXPECT_EQ(watch.judge("rear", 5), Scan::kOfThisDrive);
  EXPECT_EQ(watch.judge("front", 1), Scan::kOfThisDrive);
}

TEST(DriveWatch, DoesNotFallBackWhenAScannerIsLate) {
  DriveWatch watch;
  watch.judge("front", 1);
  watch.judge("rear", 5);
  EXPECT_EQ(watch.judge("front", 2), Scan::kOfNewDrive);
  EXPECT_EQ(watch.judge("rear", 5), Scan::kOfEarlierDrive);
  EXPECT_EQ(watch.judge("rear", 6), Scan::kOfThisDrive);
}

TEST(DriveWatch, GoesOnWhereAnotherOneEnded) {
  DriveWatch before, after;
  before.judge("front", 1);
  after.take_up(before.drives());
  EXPECT_EQ(after.judge("front", 1), Scan::kOfThisDrive);
  EXPECT_EQ(after.judge("front", 2), Scan::kOfNewDrive);
}

}  // namespace
}  // namespace slammot::localization
