#include "services/inspector/table_text.hpp"

#include <gtest/gtest.h>

namespace slammot::inspector {
namespace {

TEST(TableText, AlignsNamesToTheLeftAndNumbersToTheRight) {
  EXPECT_EQ(table_text({"topic", "Hz"}, {{"scan", "37.5"}, {"odometry", "5"}}, 1),
            "topic       Hz\n"
            "scan      37.5\n"
            "odometry     5\n");
}

TEST(TableText, LeavesNoSpaceAtTheEndOfALine) {
  EXPECT_EQ(table_text({"a", "b"}, {{"long", "x"}, {"y", ""}}, 2), "a     b\nlong  x\ny\n");
}

}  // namespace
}  // namespace slammot::inspector
