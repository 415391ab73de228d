#include "common/files/text.hpp"

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

TEST(Text, IsFormattedAsByPrintf) {
  EXPECT_EQ(text("%s at %.1f s", "lost", 2.25), "lost at 2.2 s");
  EXPECT_EQ(text("%d %%", 5), "5 %");
}

TEST(Text, IsCutWhereItIsTooLong) {
  EXPECT_EQ(text("%s", std::string(1000, 'a').c_str()), std::string(511, 'a'));
}

}  // namespace
}  // namespace slammot::files
