#include "common/bags/bag.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/bag_bytes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::bags {
namespace {

using ::testing::HasSubstr;
using testing::MessageSpec;
using testing::Wire;

const std::vector<MessageSpec> kMessages = testing::straight_bag(Wire::kCdrLittle, 5);

struct Heard {
  std::vector<std::string> bytes;
  std::vector<std::string> topics;
  std::string damage;
};

class BagTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }

  Heard hear(const std::filesystem::path& path) {
    Heard heard;
    auto bag = open_bag(path);
    EXPECT_TRUE(bag.messages) << bag.fault;
    if (!bag.messages) return heard;
    while (const auto message = bag.messages->next()) {
      heard.bytes.emplace_back(text_of(message->bytes));
      heard.topics.push_back(message->channel->topic);
      EXPECT_LE(bag.messages->fraction_read(), 1.0);
    }
    heard.damage = bag.messages->damage();
    return heard;
  }

  void expect_all(const Heard& heard) {
    ASSERT_EQ(heard.bytes.size(), kMessages.size());
    for (std::size_t i = 0; i < kMessages.size(); ++i) {
      EXPECT_EQ(heard.bytes[i], kMessages[i].bytes);
      EXPECT_EQ(heard.topics[i], kMessages[i].topic);
    }
    EXPECT_EQ(heard.damage, "");
  }

  testing::TemporaryFolder folder_;
};

TEST_F(BagTest, ReadsMcapInEveryCompression) {
  for (const char* compression : {"", "lz4", "zstd", "no chunks"}) {
    write("drive.mcap", testing::mcap_file(kMessages, compression));
    EXPECT_TRUE(is_bag(folder_ / "drive.mcap"));
    expect_all(hear(folder_ / "drive.mcap"));
  }
}

TEST_F(BagTest, ReadsBagsOfRos1InEveryCompression) {
  for (const char* compression : {"none", "lz4", "bz2"}) {
    write("drive.bag", testing::ros1_file(kMessages, compression));
    expect_all(hear(folder_ / "drive.bag"));
  }
}

TEST_F(BagTest, ReadsDatabases) {
  testing::write_db3(folder_ / "drive.db3", kMessages);
  expect_all(hear(folder_ / "drive.db3"));
}

TEST_F(BagTest, ReadsFilesAndMessagesThatArePackedByZstd) {
  write("drive.mcap.zstd", testing::packed("zstd", testing::mcap_file(kMessages, "lz4")));
  expect_all(hear(folder_ / "drive.mcap.zstd"));
  std::vector<MessageSpec> packed = kMessages;
  for (MessageSpec& message : packed) message.bytes = testing::packed("zstd", message.bytes);
  testing::write_db3(folder_ / "packed.db3", packed);
  expect_all(hear(folder_ / "packed.db3"));
  std::ifstream file(folder_ / "packed.db3", std::ios::binary);
  write("file.db3.zstd", testing::packed("zstd", {std::istreambuf_iterator<char>(file), {}}));
  expect_all(hear(folder_ / "file.db3.zstd"));
}

TEST_F(BagTest, ReadsTheFilesOfAFolderInTheOrderOfTheirNumbers) {
  std::filesystem::create_directory(folder_ / "drive");
  const auto middle = kMessages.begin() + 3;
  write("drive/drive_10.mcap", testing::mcap_file({middle, kMessages.end()}, "zstd"));
  write("drive/drive_9.mcap", testing::mcap_file({kMessages.begin(), middle}, "zstd"));
  write("drive/metadata.yaml", "rosbag2_bagfile_information:\n");
  EXPECT_TRUE(is_bag(folder_ / "drive"));
  expect_all(hear(folder_ / "drive"));
}

TEST_F(BagTest, GivesWhatComesBeforeACutAndNamesThePlace) {
  for (const char* compression : {"", "zstd", "no chunks"}) {
    const std::string whole = testing::mcap_file(kMessages, compression);
    std::size_t most = 0;
    for (std::size_t size = 8; size + 60 < whole.size(); size += 37) {
      write("cut.mcap", whole.substr(0, size));
      const Heard heard = hear(folder_ / "cut.mcap");
      EXPECT_NE(heard.damage, "") << size;
      for (std::size_t i = 0; i < heard.bytes.size(); ++i)
        ASSERT_EQ(heard.bytes[i], kMessages[i].bytes) << size;
      EXPECT_GE(heard.bytes.size(), most);
      most = heard.bytes.size();
    }
    EXPECT_GE(most, kMessages.size() - 2);
  }
}

TEST_F(BagTest, GivesWhatComesBeforeACutInABagOfRos1) {
  const std::string whole = testing::ros1_file(kMessages, "none");
  write("cut.bag", whole.substr(0, whole.size() - 10));
  const Heard heard = hear(folder_ / "cut.bag");
  EXPECT_EQ(heard.bytes.size(), kMessages.size() - 1);
  EXPECT_THAT(heard.damage, HasSubstr("ends in the record at byte"));
}

TEST_F(BagTest, LeavesOutAChunkThatFailsItsChecksum) {
  std::string file = testing::mcap_file(kMessages, "");
  const std::size_t inside = file.find(kMessages[1].bytes);
  file[inside + 20] = static_cast<char>(file[inside + 20] ^ 1);
  write("damaged.mcap", file);
  const Heard heard = hear(folder_ / "damaged.mcap");
  EXPECT_EQ(heard.bytes.size(), kMessages.size() - 2);
  EXPECT_THAT(heard.damage, HasSubstr("fails its checksum"));
}

TEST_F(BagTest, MakesNoRoomForSizesThatAreNotTrue) {
  const std::string magic("\x89MCAP0\r\n", 8);
  write("huge.mcap",
        magic + testing::raw(std::uint8_t{6}) + testing::raw(std::uint64_t{1} << 27) + "short");
  EXPECT_THAT(hear(folder_ / "huge.mcap").damage, HasSubstr("ends in the record at byte 8"));
  write("huger.mcap",
        magic + testing::raw(std::uint8_t{6}) + testing::raw(~std::uint64_t{0}) + "short");
  EXPECT_NE(hear(folder_ / "huger.mcap").damage, "");
}

TEST_F(BagTest, RefusesBagsThatAreDamagedAtTheirBeginning) {
  for (const char* name : {"drive.mcap", "drive.bag", "drive.db3.zstd"}) {
    write(name, "\x28\xB5\x2F\xFD these bytes are no bag");
    EXPECT_TRUE(is_bag(folder_ / name));
    EXPECT_THAT(open_bag(folder_ / name).fault, HasSubstr("does not begin as a bag"));
  }
}

TEST_F(BagTest, RefusesWhatIsNoBag) {
  write("drive.log", "ODOM 0 0 0 0 0 0 1 h 1\n");
  EXPECT_FALSE(is_bag(folder_ / "drive.log"));
  EXPECT_FALSE(is_bag(folder_.path()));
  write("old.bag", "#ROSBAG V1.2\n");
  EXPECT_THAT(open_bag(folder_ / "old.bag").fault, HasSubstr("rosbag migrate"));
}

TEST_F(BagTest, ReadsNoDatabaseOfSomethingElse) {
  testing::write_db3(folder_ / "drive.db3", {});
  sqlite3* database = nullptr;
  sqlite3_open((folder_ / "drive.db3").c_str(), &database);
  sqlite3_exec(
      database,
      "DROP TABLE messages; CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL "
      "SELECT i FROM n) SELECT 1 AS topic_id, i AS timestamp, x'00' AS data, i AS id FROM n",
      nullptr, nullptr, nullptr);
  sqlite3_close(database);
  EXPECT_THAT(hear(folder_ / "drive.db3").damage, HasSubstr("no tables"));
}

}  // namespace
}  // namespace slammot::bags
