#include "common/memory/spares.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace slammot::memory {
namespace {

TEST(Spares, GiveBackWhatWasCutOff) {
  Spares<std::vector<int>> spares;
  std::vector<std::vector<int>> things(3, std::vector<int>(10, 7));
  const int* const memory = things[2].data();
  spares.resize(things, 2);
  EXPECT_EQ(things.size(), 2U);
  spares.resize(things, 4);
  ASSERT_EQ(things.size(), 4U);
  EXPECT_EQ(things[2].data(), memory);
  EXPECT_EQ(things[2], std::vector<int>(10, 7));
  EXPECT_TRUE(things[3].empty());
}

TEST(Spares, AreMadeWhereThereAreNone) {
  Spares<std::vector<int>> spares;
  EXPECT_TRUE(spares.take().empty());
  spares.give({1, 2});
  EXPECT_EQ(spares.take(), (std::vector<int>{1, 2}));
  EXPECT_TRUE(spares.take().empty());
}

}  // namespace
}  // namespace slammot::memory
