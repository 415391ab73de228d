#include "services/slammot/profile.hpp"

#include <gtest/gtest.h>

#include "common/config/print.hpp"
#include "tests/fuzz/mutation.hpp"

namespace slammot {
namespace {

using slammot::testing::mutated;
using slammot::testing::random_bytes;
using slammot::testing::random_words;

const std::vector<std::string_view> kWords = {"localization",
                                              "ingest",
                                              "map_store",
                                              "map",
                                              "evidence",
                                              "{",
                                              "}",
                                              ":",
                                              "[",
                                              "]",
                                              "<",
                                              ">",
                                              ";",
                                              ",",
                                              "#",
                                              "\"",
                                              "'",
                                              "\\x",
                                              "side_m",
                                              "cell_size_m",
                                              "match_range_m",
                                              "max_pending",
                                              "0",
                                              "-1",
                                              "1",
                                              "1e400",
                                              "nan",
                                              "-inf",
                                              "0x7fffffff",
                                              "99999999999999999999",
                                              "0.2",
                                              "true",
                                              "false",
                                              "\n",
                                              "\0",
                                              "\xff",
                                              "[google.protobuf.Any]",
                                              "type.googleapis.com/x"};

/// Whatever is accepted is within its ranges; whatever is not is explained in one line. True if it
/// is accepted.
bool is_accepted(const std::string& text) {
  Profile profile;
  const auto stages = bind_stages(profile);
  if (const auto fault = config::overlay_text(text, "drive.textproto", stages)) {
    EXPECT_EQ(fault->text().rfind("drive.textproto", 0), 0U);
    EXPECT_FALSE(fault->message.empty());
    EXPECT_EQ(fault->message.find('\n'), std::string::npos) << fault->message;
    return false;
  }
  for (const auto& stage : stages) EXPECT_FALSE(config::find_fault(stage)) << text;
  return true;
}

std::string whole_profile() {
  Profile profile;
  return config::print(bind_stages(profile));
}

TEST(ProfileFuzz, SurvivesAnyBytes) {
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 1500; ++i) refused += is_accepted(random_bytes(300, random)) ? 0 : 1;
  EXPECT_GT(refused, 1400);  // a comment or blanks may be all there is
}

TEST(ProfileFuzz, SurvivesTheWordsOfAProfileInAnyOrder) {
  std::mt19937 random(2);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) refused += is_accepted(random_words(kWords, 30, random)) ? 0 : 1;
  EXPECT_GT(refused, 1800);
}

TEST(ProfileFuzz, SurvivesDamagedProfiles) {
  std::mt19937 random(3);
  const std::string whole = whole_profile();
  int accepted = 0;
  for (int i = 0; i < 400; ++i) accepted += is_accepted(mutated(whole, kWords, random)) ? 1 : 0;
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, 400);
}

TEST(ProfileFuzz, SurvivesNestingWithoutEnd) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += "localization { map {";
  EXPECT_FALSE(is_accepted(text));
}

TEST(ProfileFuzz, TakesItsOwnPrint) {
  const std::string whole = whole_profile();
  Profile profile;
  const auto fault = config::overlay_text(whole, "drive.textproto", bind_stages(profile));
  ASSERT_FALSE(fault) << fault->text();
  EXPECT_EQ(config::print(bind_stages(profile)), whole);
}

}  // namespace
}  // namespace slammot
