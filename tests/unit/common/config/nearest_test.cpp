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
  EXPECT_EQ(nearest("abx", {"abc", "abd"}), "abc") << "the first of several";
}

TEST(Nearest, IsNoneWhereMoreThanAThirdOfTheLettersDiffer) {
  EXPECT_EQ(nearest("size_m", {"side_m"}), "side_m");
  EXPECT_EQ(nearest("NONSENSE", {"cell_size_m", "side_m", "loops"}), std::nullopt);
  EXPECT_EQ(nearest("abx", {"acd"}), std::nullopt);
  EXPECT_EQ(nearest("side_m", {}), std::nullopt);
}

TEST(HintAtNearest, IsEmptyWhereNoneIsNear) {
  EXPECT_EQ(hint_at_nearest("sde_m", {"side_m"}), "; the nearest one is 'side_m'");
  EXPECT_EQ(hint_at_nearest("NONSENSE", {"side_m"}), "");
}

}  // namespace
}  // namespace slammot::config
