#include "services/collision_warning/warning_level.hpp"

#include <gtest/gtest.h>

namespace slammot::collision_warning {
namespace {

using flow::WarningLevel;

const CollisionWarningConfig kConfig;
constexpr std::int64_t kPeriodNs = 25'000'000;

struct LevelOfAnObject : ::testing::Test {
  LevelOverTime level;
  std::int64_t now_ns = 7'000'000'000;

  /// Level after this contact was predicted for so long.
  WarningLevel after(double duration_s, const std::optional<Contact>& contact) {
    WarningLevel now = WarningLevel::kNone;
    const std::int64_t end_ns = now_ns + static_cast<std::int64_t>(duration_s * 1e9);
    for (; now_ns <= end_ns; now_ns += kPeriodNs) now = level.update(now_ns, contact, kConfig);
    return now;
  }
};

TEST_F(LevelOfAnObject, IsAWarningOnceALikelyContactIsConfirmed) {
  EXPECT_EQ(after(0.05, Contact{0.9, 2.0}), WarningLevel::kNone);
  EXPECT_EQ(after(kConfig.confirm_s, Contact{0.9, 2.0}), WarningLevel::kWarning);
}

TEST_F(LevelOfAnObject, IsConfirmedLaterWhileTheContactIsFar) {
  EXPECT_NE(after(1.5 * kConfig.confirm_s, Contact{0.9, 2.8}), WarningLevel::kWarning);
  EXPECT_EQ(after(kConfig.confirm_s, Contact{0.9, 2.8}), WarningLevel::kWarning);
}

TEST_F(LevelOfAnObject, IsAWarningSoonerOnceTheContactIsNear) {
  after(0.7 * kConfig.confirm_s, Contact{0.9, 2.3});
  EXPECT_EQ(after(0.0, Contact{0.9, 2.1}), WarningLevel::kWarning);
}

TEST_F(LevelOfAnObject, IsNoneForOneWrongPrediction) {
  EXPECT_EQ(after(0.0, Contact{1.0, 1.0}), WarningLevel::kNone);
  EXPECT_EQ(after(1.0, std::nullopt), WarningLevel::kNone);
}

TEST_F(LevelOfAnObject, IsACautionWhileTheContactIsFarAheadOrDoubtful) {
  EXPECT_EQ(after(0.5, Contact{0.9, kConfig.warning_time_s + 0.5}), WarningLevel::kCaution);
  EXPECT_EQ(after(0.5, Contact{0.9 * kConfig.warning_probability, 1.0}), WarningLevel::kCaution);
}

TEST_F(LevelOfAnObject, IsHeldThroughAGapAndEndsAfterIt) {
  EXPECT_EQ(after(0.5, Contact{0.9, 2.0}), WarningLevel::kWarning);
  EXPECT_EQ(after(0.8 * kConfig.hold_s, std::nullopt), WarningLevel::kWarning);
  EXPECT_EQ(after(0.4 * kConfig.hold_s, std::nullopt), WarningLevel::kNone);
}

TEST_F(LevelOfAnObject, DoesNotFlickerAboutTheThreshold) {
  EXPECT_EQ(after(0.5, Contact{0.9, 2.0}), WarningLevel::kWarning);
  EXPECT_EQ(after(3.0, Contact{0.9 * kConfig.warning_probability, 2.0}), WarningLevel::kWarning);
  EXPECT_EQ(after(1.0, Contact{0.5 * kConfig.warning_probability, 2.0}), WarningLevel::kCaution);
}

TEST_F(LevelOfAnObject, IsOverOnceTheObjectIsGone) {
  after(0.5, Contact{0.9, 2.0});
  EXPECT_FALSE(level.is_over(now_ns, kConfig));
  EXPECT_TRUE(level.is_over(now_ns + 1'000'000'000, kConfig));
}

}  // namespace
}  // namespace slammot::collision_warning
