#include "common/files/foreign_file.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/files/carmen_log.hpp"
#include "tests/support/bag_bytes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::straight_drive;
using testing::write_file;
using testing::write_gz;

class ForeignFile : public ::testing::Test {
 protected:
  static std::string refusal(const std::filesystem::path& path) {
    const auto log = CarmenLog::open(path);
    EXPECT_FALSE(log) << path;
    return log ? "" : log.error().message;
  }

  std::string refusal_of(std::string_view content) {
    write_file(file_, content);
    return refusal(file_);
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "drive.log";
};

TEST_F(ForeignFile, IsNamedByItsFirstBytes) {
  using std::string_literals::operator""s;
  EXPECT_THAT(refusal_of("BZh91AY&SY"), HasSubstr("compressed by bzip2: unpack it first"));
  EXPECT_THAT(refusal_of("\xfd"
                         "7zXZ\0\0"s),
              HasSubstr("compressed by xz: unpack it first"));
  EXPECT_THAT(refusal_of("PK\x03\x04\x14"), HasSubstr("zip archive"));
  EXPECT_THAT(refusal_of("\xff\xfe#\0 \0"s), HasSubstr("UTF-16"));
  EXPECT_THAT(refusal_of("\n<!DOCTYPE HTML>\n<html>"), HasSubstr("web page"));
  EXPECT_THAT(refusal_of("version https://git-lfs.github.com/spec/v1\noid sha256:0\n"),
              HasSubstr("git lfs pull"));
  EXPECT_THAT(refusal_of("rosbag2_bagfile_information:\n  version: 5\n"),
              HasSubstr("name the folder"));
  EXPECT_THAT(refusal_of("# a log\rFLASER 1 1\rFLASER 1 1\r"), HasSubstr("CR alone"));
}

TEST_F(ForeignFile, IsNamedWhateverItsNameSays) {
  file_ = folder_ / "drive.bag";
  EXPECT_THAT(refusal_of("version https://git-lfs.github.com/spec/v1\n"),
              HasSubstr("git lfs pull"));
}

TEST_F(ForeignFile, IsNoTextWithBytesThatNoTextHas) {
  EXPECT_TRUE(foreign_content("a\rb"));
  EXPECT_FALSE(foreign_content(std::string_view("\x28\xb5\x2f\xfd\x01\rb", 7)))
      << "compressed bytes may hold a CR, and no LF";
}

TEST_F(ForeignFile, IsNamedWithinGzip) {
  file_ = folder_ / "drive.log.gz";
  write_gz(file_, straight_drive(10));
  const std::string once = testing::read_file(file_);
  write_gz(file_, once);
  EXPECT_THAT(refusal(file_), HasSubstr("compressed by gzip twice"));
  write_gz(file_, testing::mcap_file(testing::straight_bag(testing::Wire::kCdrLittle, 3), ""));
  EXPECT_THAT(refusal(file_), HasSubstr("a bag compressed by gzip"));
}

TEST_F(ForeignFile, IsNoLogWithItsUsualLineEnds) {
  write_gz(file_, straight_drive(10));
  EXPECT_TRUE(CarmenLog::open(file_));
  EXPECT_FALSE(foreign_content("# CARMEN Logfile\r\nPARAM a 1\r\n"));
  EXPECT_FALSE(foreign_content("PARAM a 1\r"));
  EXPECT_FALSE(foreign_content(""));
}

TEST_F(ForeignFile, IsAFolderWithoutADrive) {
  EXPECT_THAT(refusal(folder_.path()),
              AllOf(HasSubstr("neither files of a ROS bag"), HasSubstr("scan.txt")));
  for (const char* const name : {"d.log.gz", "b.log", "a.clf", "c.log", "readme.md"})
    write_file(folder_ / name, "x");
  EXPECT_THAT(refusal(folder_.path()),
              HasSubstr("it holds 4 files that may be logs (a.clf, b.log, c.log, ...): name one"));
}

TEST_F(ForeignFile, IsStandardInput) {
  EXPECT_THAT(refusal("-"), HasSubstr("read several times and must be a file"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("read several times and must be a file"));
}

}  // namespace
}  // namespace slammot::files
