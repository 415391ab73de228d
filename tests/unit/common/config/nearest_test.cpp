#include "common/config/nearest.hpp"

#include <gtest/gtest.h>

namespace slammot::config {
namespace {

TEST(EditDistance, CountsLettersThatDiffer) {
  EXPECT_EQ(edit_distance("side_m", "side_m"), 0U);
  EXPECT_EQ(edit_distance("side_m", "sde_m"), 1U);
  EXPECT_EQ(edit_distance("side_m", "size_m"), 1U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(Nearest, IsTheNameWithTheFewestDifferences) {
  EXPECT_EQ(nearest("sde_m", {"cell_size_m", "side_m", "surfel_size_m"}), "side_m");
  EXPECT_EQ(nearest("x", {"a", "b"}), "a");
}

}  // namespace
}  // namespace slammot::config
