#include "common/files/line_reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::read_file;
using testing::write_file;
using testing::write_gz;

class LineReaderTest : public ::testing::Test {
 protected:
  static std::vector<std::string> lines_of(LineReader& reader) {
    std::vector<std::string> lines;
    while (const auto line = reader.next()) lines.emplace_back(*line);
    return lines;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "text";
};

TEST_F(LineReaderTest, ReadsLinesWithEitherEndAndTheLastOneWithout) {
  write_file(file_, "one\ntwo\r\n\nthree");
  auto reader = LineReader::open(file_);
  ASSERT_TRUE(reader);
  EXPECT_THAT(lines_of(*reader), ElementsAre("one", "two", "", "three"));
  EXPECT_EQ(reader->line_number(), 4u);
  EXPECT_TRUE(reader->last_line_is_unfinished());
  EXPECT_FALSE(reader->is_cut());
  EXPECT_DOUBLE_EQ(reader->fraction_read(), 1.0);
}

TEST_F(LineReaderTest, ReadsCompressedFilesWhateverTheirName) {
  write_gz(file_, "one\ntwo\n");
  auto reader = LineReader::open(file_);
  ASSERT_TRUE(reader);
  EXPECT_THAT(lines_of(*reader), ElementsAre("one", "two"));
  EXPECT_FALSE(reader->last_line_is_unfinished());
  EXPECT_FALSE(reader->is_cut());
}

TEST_F(LineReaderTest, LosesNothingOfAFileOfManyChunks) {
  std::vector<std::string> lines;
  for (int i = 0; i < 100'000; ++i) lines.push_back("line " + std::to_string(i * 7919 % 100'003));
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  write_gz(file_, text);
  auto reader = LineReader::open(file_);
  ASSERT_TRUE(reader);
  EXPECT_EQ(lines_of(*reader), lines);
  EXPECT_FALSE(reader->is_cut());
  EXPECT_DOUBLE_EQ(reader->fraction_read(), 1.0);
}

TEST_F(LineReaderTest, GivesOutWhatCanBeReadOfACutFileAndSaysThatItIsCut) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += "line " + std::to_string(i * 7919 % 10'007) + "\n";
  write_gz(file_, text);
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  auto reader = LineReader::open(file_);
  ASSERT_TRUE(reader);
  const auto lines = lines_of(*reader);
  EXPECT_GT(lines.size(), 1'000u);
  EXPECT_LT(lines.size(), 19'000u);
  EXPECT_EQ(lines.front(), "line 0");
  EXPECT_TRUE(reader->is_cut());
}

TEST_F(LineReaderTest, GivesOutWhatComesBeforeDamageAndSaysThatItIsCut) {
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += "line " + std::to_string(i * 7919 % 100'003) + "\n";
  write_gz(file_, text);
  std::string bytes = read_file(file_);
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 64; ++i) bytes[i] = '\xff';
  write_file(file_, bytes);
  auto reader = LineReader::open(file_);
  ASSERT_TRUE(reader);
  lines_of(*reader);
  EXPECT_TRUE(reader->is_cut());
}

TEST_F(LineReaderTest, SkipsAndCountsLinesThatAreMegabytesLong) {
  write_file(file_, "one\n" + std::string(3 * LineReader::kMaxLineBytes, 'x') + "\ntwo\n");
  auto reader = LineReader::open(file_);
  ASSERT_TRUE(reader);
  EXPECT_THAT(lines_of(*reader), ElementsAre("one", "two"));
  EXPECT_EQ(reader->overlong_lines(), 1u);
  EXPECT_EQ(reader->line_number(), 3u);
}

TEST_F(LineReaderTest, RefusesWhatIsMissingEmptyOrNoFile) {
  EXPECT_THAT(LineReader::open(file_).error().message, HasSubstr("no such file"));
  write_file(file_, "");
  EXPECT_THAT(LineReader::open(file_).error().message, HasSubstr("the file is empty"));
  EXPECT_THAT(LineReader::open(folder_.path()).error().message, HasSubstr("not a regular file"));
}

}  // namespace
}  // namespace slammot::files
