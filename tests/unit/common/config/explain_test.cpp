#include "common/config/explain.hpp"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/common/config/example_stage.hpp"

namespace slammot::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<Explanation> explain_example() {
  static ExampleConfig config;
  const std::array stages = {bind_example(config)};
  return explain(stages);
}

std::vector<std::string> names_of(const std::vector<Explanation>& settings) {
  std::vector<std::string> names;
  for (const Explanation& setting : settings) names.push_back(setting.name);
  return names;
}

std::string unit_of(std::string name, std::string_view meaning = "") {
  double number = 0.0;
  return config::unit_of({std::move(name), &number, meaning, {}});
}

TEST(Explain, ListsSettingsByGroupAndThoseWithoutOneLast) {
  EXPECT_THAT(names_of(explain_example()),
              ElementsAre("example.offset.x_m", "example.resend_after_s", "example.window_scans",
                          "example.loops", "example.name"));
}

TEST(Explain, TellsUnitRangeDefaultAndWhatGoesWrong) {
  const Explanation setting = explain_example().at(1);
  EXPECT_EQ(setting.group, "operation: the services at run time");
  EXPECT_EQ(setting.unit, "s");
  EXPECT_EQ(setting.range, "above 0");
  EXPECT_EQ(setting.value, "1");
  EXPECT_EQ(setting.meaning, "Silence.");
  EXPECT_EQ(setting.too_small, "Sent twice.");
  EXPECT_EQ(setting.too_large, "Late.");
}

TEST(Explain, NamesTheKindOfWhatIsNoNumber) {
  EXPECT_EQ(explain_example().at(3).unit, "yes or no");
  EXPECT_EQ(explain_example().at(4).unit, "text");
}

TEST(UnitOf, IsWhatTheNameEndsInOrWhatTheMeaningSaysInBrackets) {
  EXPECT_EQ(unit_of("drift_m_per_sqrt_m"), "m per sqrt(m)");
  EXPECT_EQ(unit_of("cell_size_m"), "m");
  EXPECT_EQ(unit_of("fastest_mps"), "m/s");
  EXPECT_EQ(unit_of("heading_noise_per_m", "What each metre adds [rad/m]."), "rad/m");
  EXPECT_EQ(unit_of("samples"), "");
}

TEST(Named, FindsByNameByItsEndByItsBeginningAndByGroup) {
  const auto all = explain_example();
  EXPECT_THAT(names_of(named("example.offset.x_m", all)), ElementsAre("example.offset.x_m"));
  EXPECT_THAT(names_of(named("x_m", all)), ElementsAre("example.offset.x_m"));
  EXPECT_THAT(names_of(named("offset", all)), ElementsAre("example.offset.x_m"));
  EXPECT_THAT(names_of(named("operation", all)), ElementsAre("example.resend_after_s"));
  EXPECT_EQ(named("example", all).size(), all.size());
  EXPECT_TRUE(named("x", all).empty());
}

TEST(ExplanationText, HasATitleAGroupAndLinesASetting) {
  const std::string text = explanation_text(named("operation", explain_example()));
  EXPECT_EQ(text,
            "operation: the services at run time\n"
            "\n"
            "  example.resend_after_s  (s, above 0, default 1)\n"
            "      Silence.\n"
            "      Too small: Sent twice.\n"
            "      Too large: Late.\n");
}

TEST(ExplanationTables, HaveARowASetting) {
  const std::string page = explanation_tables(explain_example());
  EXPECT_THAT(page, HasSubstr("## sensor: "));
  EXPECT_THAT(
      page,
      HasSubstr(
          "| `example.resend_after_s` | s | above 0 | `1` | Silence. | Sent twice. | Late. |\n"));
}

TEST(ExplanationLines, HaveALineASetting) {
  EXPECT_THAT(explanation_lines(explain_example()),
              HasSubstr("\n  example.window_scans = 1  Scans in flight.\n"));
}

}  // namespace
}  // namespace slammot::config
