#include "common/wire/text.hpp"

#include <cstring>

#include <gtest/gtest.h>

namespace slammot::wire {
namespace {

TEST(Text, ComesBackAsItWas) {
  char field[9];
  set_text(field, "front");
  EXPECT_EQ(text(field), "front");
}

TEST(Text, IsCutOffWhereItDoesNotFit) {
  char field[5];
  set_text(field, "front");
  EXPECT_EQ(text(field), "fron");
}

TEST(Text, LeavesNothingOfALongerOneBefore) {
  char field[9];
  set_text(field, "longlong");
  set_text(field, "a");
  for (std::size_t i = 1; i < sizeof field; ++i) EXPECT_EQ(field[i], '\0');
}

TEST(Text, WithoutAnEndIsTheWholeField) {
  char field[4];
  std::memset(field, 'x', sizeof field);
  EXPECT_EQ(text(field), "xxxx");
}

}  // namespace
}  // namespace slammot::wire
