#include "common/config/fields.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/common/config/example_stage.hpp"

namespace slammot::config {
namespace {

TEST(FindFault, AcceptsTheDefaults) {
  ExampleConfig config;
  EXPECT_EQ(find_fault(bind_example(config)), std::nullopt);
}

TEST(FindFault, NamesTheStageTheFieldItsValueItsRangeAndItsMeaning) {
  ExampleConfig config;
  config.window_scans = 101;
  EXPECT_EQ(find_fault(bind_example(config)),
            "example.window_scans = 101 is outside [1, 100]: Scans in flight.");
}

TEST(FindFault, AcceptsBothEndsOfARange) {
  ExampleConfig config;
  for (const int end : {1, 100}) {
    config.window_scans = end;
    EXPECT_EQ(find_fault(bind_example(config)), std::nullopt);
  }
}

TEST(FindFault, NeverAcceptsNanOrInfinity) {
  ExampleConfig config;
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    config.resend_after_s = bad;
    EXPECT_NE(find_fault(bind_example(config)), std::nullopt) << bad;
  }
}

TEST(FindFault, TakesZeroForNotPositiveButForNotNegative) {
  ExampleConfig config;
  config.offset.x_m = 0.0;
  EXPECT_EQ(find_fault(bind_example(config)), std::nullopt);
  config.resend_after_s = 0.0;
  EXPECT_EQ(find_fault(bind_example(config)),
            "example.resend_after_s = 0 is not above 0: Silence.");
}

TEST(FindFault, NamesTheLimitOfWhatIsFarTooLargeOrSmall) {
  ExampleConfig config;
  config.resend_after_s = 1e300;
  EXPECT_EQ(find_fault(bind_example(config)),
            "example.resend_after_s = 1e+300 is above 1e+09: Silence.");
  config.resend_after_s = 1e-300;
  EXPECT_EQ(find_fault(bind_example(config)),
            "example.resend_after_s = 1e-300 is below 1e-09: Silence.");
}

TEST(BindStage, PointsIntoTheStructItWasGiven) {
  ExampleConfig config;
  const BoundStage stage = bind_example(config);
  *std::get<double*>(stage.fields[4].value) = 3.5;
  EXPECT_EQ(config.offset.x_m, 3.5);
}

TEST(WithMembersOf, BindsTheMembersOfAMemberUnderTheirOwnNames) {
  const FieldTable<ExampleInnerConfig> inner = {{"x_m", &ExampleInnerConfig::x_m, "Ahead."}};
  ExampleConfig config;
  const BoundStage stage = bind_stage(
      "example", with_members_of<ExampleConfig>({}, &ExampleConfig::offset, inner), config);
  ASSERT_EQ(stage.fields.size(), 1U);
  EXPECT_EQ(stage.fields[0].name, "x_m");
  *std::get<double*>(stage.fields[0].value) = 3.5;
  EXPECT_EQ(config.offset.x_m, 3.5);
}

}  // namespace
}  // namespace slammot::config
