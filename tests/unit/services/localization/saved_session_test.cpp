#include "services/localization/saved_session.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/values.hpp"

namespace slammot::localization {
namespace {

SavedSession example_session() {
  std::mt19937 random(1);
  SavedSession session{{42},
                       {43},
                       {5},
                       {{"front", 7}, {"rear", 8}},
                       {slammot::testing::localized_scan(random, 0)},
                       true,
                       {std::byte{1}, std::byte{2}}};
  session.last_answers.front().scanner_id = "front";
  return session;
}

TEST(SavedSession, ComesBackFromItsBytes) {
  const SavedSession session = example_session();
  const auto back = session_of(to_bytes(session));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->map_id, session.map_id);
  EXPECT_EQ(back->odom_id, session.odom_id);
  EXPECT_EQ(back->first_submap_id, session.first_submap_id);
  EXPECT_EQ(back->drive_by_scanner, session.drive_by_scanner);
  EXPECT_TRUE(back->has_ended);
  EXPECT_EQ(back->localizer, session.localizer);
  ASSERT_EQ(back->last_answers.size(), 1U);
  EXPECT_EQ(to_bytes(*back), to_bytes(session)) << "every member of the answers too";
}

TEST(SavedSession, IsNotMadeOfBytesThatAreCutOffOrTooMany) {
  std::vector<std::byte> bytes = to_bytes(example_session());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(session_of(std::span(bytes).first(size))) << size;
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(session_of(bytes));
}

}  // namespace
}  // namespace slammot::localization
