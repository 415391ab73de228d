// Tests of `slammot bag` on small generated recordings.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/mcap/file.hpp"
#include "tests/support/command_line_call.hpp"
#include "tests/support/mcap_example.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot {
namespace {

using ::testing::HasSubstr;
using testing::Outcome;

class BagCommand : public ::testing::Test {
 protected:
  BagCommand() {
    testing::write_example(whole_, testing::example_messages(300), mcap::Compression::kZstd);
  }

  Outcome cut(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"bag", "cut", whole_.string(), "--output", output_.string()};
    words.insert(words.end(), more.begin(), more.end());
    return testing::call(words);
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path whole_ = folder_.path() / "whole.mcap";  ///< 3 s.
  std::filesystem::path output_ = folder_.path() / "output.mcap";
};

TEST_F(BagCommand, CutsATimeAndATopic) {
  ASSERT_EQ(cut({"--from", "1", "--duration", "1", "--topics", "scans"}).exit_code, kExitDone);
  const auto file = mcap::File::open(output_);
  ASSERT_TRUE(file);
  EXPECT_NEAR(static_cast<double>(file->contents().statistics.message_count), 50.0, 1.0);
}

TEST_F(BagCommand, RefusesToCutWhereNoTimeIs) {
  for (const char* const seconds : {"nan", "inf", "-5", "9e9", "1e300"}) {
    for (const char* const option : {"--from", "--duration"}) {
      const Outcome outcome = cut({option, seconds});
      EXPECT_EQ(outcome.exit_code, kExitUsage) << option << " " << seconds;
      EXPECT_THAT(outcome.standard_error, HasSubstr("0 or more and at most 1e9"));
      EXPECT_FALSE(std::filesystem::exists(output_));
    }
  }
}

TEST_F(BagCommand, RefusesToCutWhatIsNotInTheFile) {
  const auto expect_refused = [this](const std::vector<std::string>& words,
                                     const std::string& reason) {
    const Outcome outcome = cut(words);
    EXPECT_EQ(outcome.exit_code, kExitFault) << reason;
    EXPECT_THAT(outcome.standard_error, HasSubstr(reason));
    EXPECT_FALSE(std::filesystem::exists(output_)) << reason;
  };
  expect_refused({"--topics", "nosuch"}, "no topic is called 'nosuch'");
  expect_refused({"--topics", "scans,no*"}, "no topic is called 'no*'");
  expect_refused({"--from", "10"}, "--from is beyond the end: the recording is 3.0 s long");
}

TEST_F(BagCommand, SaysThatTwoFilesAreNeededToMerge) {
  const Outcome outcome =
      testing::call({"bag", "merge", whole_.string(), "--output", output_.string()});
  EXPECT_EQ(outcome.exit_code, kExitUsage);
  EXPECT_THAT(outcome.standard_error,
              HasSubstr("FILE takes at least 2 values, not 1, FILE: Two or more MCAP files"));
}

}  // namespace
}  // namespace slammot
