#include "services/localization/early_answers.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

flow::ScanLabels labels_of(std::int64_t stamp_ns, const std::string& scanner_id = "front") {
  flow::ScanLabels labels;
  labels.stamp_ns = stamp_ns;
  labels.scanner_id = scanner_id;
  return labels;
}

flow::TrackedObjects objects_of(std::int64_t stamp_ns, std::uint32_t sequence = 0) {
  flow::TrackedObjects objects;
  objects.stamp_ns = stamp_ns;
  objects.sequence = sequence;
  return objects;
}

TEST(EarlyAnswers, AreGivenToTheirScanOnce) {
  EarlyAnswers answers;
  for (const std::int64_t stamp_ns : {1, 2, 3}) answers.add(labels_of(stamp_ns));
  ASSERT_TRUE(answers.take_labels(2, "front"));
  EXPECT_FALSE(answers.take_labels(2, "front"));
  EXPECT_FALSE(answers.take_labels(1, "front")) << "scans come in their order";
  EXPECT_TRUE(answers.take_labels(3, "front"));
}

TEST(EarlyAnswers, TellScannersOfOneStampApart) {
  EarlyAnswers answers;
  answers.add(labels_of(1, "front"));
  answers.add(labels_of(1, "rear"));
  EXPECT_FALSE(answers.take_labels(1, "left"));
  EXPECT_TRUE(answers.take_labels(1, "front"));
  EXPECT_TRUE(answers.take_labels(1, "rear"));
}

TEST(EarlyAnswers, GiveObjectsOfOneStampInTheirOrder) {
  EarlyAnswers answers;
  answers.add(objects_of(1, 7));
  answers.add(objects_of(1, 8));
  EXPECT_EQ(answers.take_objects(1)->sequence, 7U);
  EXPECT_EQ(answers.take_objects(1)->sequence, 8U);
  EXPECT_FALSE(answers.take_objects(1));
}

TEST(EarlyAnswers, SayHowFarTheyReach) {
  EarlyAnswers answers;
  EXPECT_FALSE(answers.reach(1));
  answers.add(labels_of(5));
  EXPECT_TRUE(answers.reach(5));
  EXPECT_FALSE(answers.reach(6));
}

TEST(EarlyAnswers, ForgetTheOldestRatherThanGrow) {
  EarlyAnswers answers;
  for (std::int64_t stamp_ns = 0; stamp_ns < 1000; ++stamp_ns) answers.add(labels_of(stamp_ns));
  EXPECT_FALSE(answers.take_labels(0, "front"));
  EXPECT_TRUE(answers.take_labels(999, "front"));
}

}  // namespace
}  // namespace slammot::localization
