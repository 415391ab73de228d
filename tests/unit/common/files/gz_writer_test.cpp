#include "common/files/gz_writer.hpp"

#include <gtest/gtest.h>

#include "common/files/line_reader.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

struct GzWriterTest : ::testing::Test {
  testing::TemporaryFolder folder_;
};

TEST_F(GzWriterTest, WritesWhatIsReadBack) {
  GzWriter writer(folder_ / "text.gz");
  writer.write("one\n");
  writer.write("");
  writer.write("two\n");
  ASSERT_FALSE(writer.close());
  auto reader = LineReader::open(folder_ / "text.gz");
  ASSERT_TRUE(reader);
  EXPECT_EQ(*reader->next(), "one");
  EXPECT_EQ(*reader->next(), "two");
  EXPECT_FALSE(reader->next());
  EXPECT_FALSE(reader->is_cut());
}

TEST_F(GzWriterTest, WritesTheSameBytesTwice) {
  for (const char* name : {"a.gz", "b.gz"}) {
    GzWriter writer(folder_ / name);
    writer.write("the same");
    writer.close();
  }
  EXPECT_EQ(testing::read_file(folder_ / "a.gz"), testing::read_file(folder_ / "b.gz"));
}

TEST_F(GzWriterTest, SaysThatItCannotWrite) {
  GzWriter writer(folder_ / "nowhere" / "text.gz");
  writer.write("lost");
  EXPECT_TRUE(writer.close());
}

}  // namespace
}  // namespace slammot::files
