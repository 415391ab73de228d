#include "common/config/print.hpp"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/overlay.hpp"
#include "tests/unit/common/config/example_stage.hpp"

namespace slammot::config {
namespace {

TEST(Print, ShowsEverySettingWithItsMeaning) {
  ExampleConfig config;
  const std::array stages = {bind_example(config)};
  EXPECT_EQ(print(stages),
            "example {\n"
            "  window_scans: 1  # Scans in flight.\n"
            "  resend_after_s: 1  # Silence.\n"
            "  loops: false  # Again and again.\n"
            "  name: \"front\"  # Of the scanner.\n"
            "  offset {\n"
            "    x_m: 10  # Ahead.\n"
            "  }\n"
            "}\n");
}

TEST(Print, ReadBackGivesTheSameValues) {
  ExampleConfig config;
  config.resend_after_s = 1.0 / 3.0;
  config.offset.x_m = 1e-9;
  config.loops = true;
  config.name = "rear \"low\" \n";
  const std::array stages = {bind_example(config)};
  ExampleConfig read_back;
  const std::array stages_read_back = {bind_example(read_back)};
  ASSERT_FALSE(overlay_text(print(stages), "printed", stages_read_back));
  EXPECT_EQ(read_back.resend_after_s, config.resend_after_s);
  EXPECT_EQ(read_back.offset.x_m, config.offset.x_m);
  EXPECT_EQ(read_back.loops, config.loops);
  EXPECT_EQ(read_back.name, config.name);
}

}  // namespace
}  // namespace slammot::config
