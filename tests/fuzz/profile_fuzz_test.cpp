#include "services/slammot/profile.hpp"

#include <gtest/gtest.h>

#include "common/config/print.hpp"
#include "tests/fuzz/mutation.hpp"

namespace slammot {
namespace {

using slammot::testing::mutated;
using slammot::testing::random_bytes;
using slammot::testing::random_words;

const std::vector<std::string_view> kWords = {
    "localization", "ingest", "map_store", "map", "evidence", "{", "}", ":", "[", "]", "<", ">", ";", ",", "#", "\"", "'", "\\x",
    "side_m", "cell_size_m", "match_range_m", "max_pending", "0", "-1", "1", "1e400", "nan", "-inf", "0x7fffffff",
    "99999999999999999999", "0.2", "true", "false", "\n", "\0", "\xff", "[google.protobuf.Any]", "type.googleapis.com/x"};

/// Whatever is accepted is within its ranges; whatever is not is explained in one line.
void overlay(const std::string& text) {
  Profile profile;
  const auto stages = bind_stages(profile);
  if (const auto fault = config::overlay_text(text, "drive.textproto", stages)) {
    EXPECT_EQ(fault->text().rfind("drive.textproto", 0), 0U);
    EXPECT_FALSE(fault->message.empty());
    EXPECT_EQ(fault->message.find('\n'), std::string::npos) << fault->message;
    return;
  }
  for (const auto& stage : stages) EXPECT_FALSE(config::find_fault(stage)) << text;
}

std::string whole_profile() {
  Profile profile;
  return config::print(bind_stages(profile));
}

TEST(ProfileFuzz, SurvivesAnyBytes) {
  std::mt19937 random(1);
  for (int i = 0; i < 1500; ++i) overlay(random_bytes(300, random));
}

TEST(ProfileFuzz, SurvivesTheWordsOfAProfileInAnyOrder) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) overlay(random_words(kWords, 30, random));
}

TEST(ProfileFuzz, SurvivesDamagedProfiles) {
  std::mt19937 random(3);
  const std::string whole = whole_profile();
  for (int i = 0; i < 400; ++i) overlay(mutated(whole, kWords, random));
}

TEST(ProfileFuzz, SurvivesNestingWithoutEnd) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += "localization { map {";
  overlay(text);
}

TEST(ProfileFuzz, TakesItsOwnPrint) { overlay(whole_profile()); }

}  // namespace
}  // namespace slammot
