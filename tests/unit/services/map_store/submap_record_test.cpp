#include "services/map_store/submap_record.hpp"

#include <gtest/gtest.h>

#include "tests/support/example_submap.hpp"

namespace slammot::map_store {
namespace {

using slammot::testing::example_submap;
using slammot::testing::same_submap;

TEST(SubmapRecord, IsEqualAfterReadingBack) {
  const flow::Submap submap = example_submap(3);
  const auto read_back = from_blob(to_blob(submap));
  ASSERT_TRUE(read_back);
  EXPECT_TRUE(same_submap(*read_back, submap));
}

TEST(SubmapRecord, OfAnEmptySubmapIsReadable) {
  const auto read_back = from_blob(to_blob(flow::Submap{}));
  ASSERT_TRUE(read_back);
  EXPECT_TRUE(same_submap(*read_back, flow::Submap{}));
}

TEST(SubmapRecord, IsNotReadFromATruncatedBlob) {
  const std::string blob = to_blob(example_submap(3));
  for (std::size_t length = 0; length < blob.size(); length += 97)
    EXPECT_FALSE(from_blob(blob.substr(0, length))) << length;
}

TEST(SubmapRecord, IsNotReadFromADamagedBlob) {
  const std::string blob = to_blob(example_submap(3));
  for (std::size_t at = 0; at < blob.size(); at += 101) {
    std::string damaged = blob;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
    EXPECT_FALSE(from_blob(damaged)) << at;
  }
}

TEST(SubmapRecord, WithInconsistentSizesIsRejected) {
  flow::Submap submap = example_submap(3);
  submap.columns += 1;
  EXPECT_FALSE(from_blob(to_blob(submap)));
}

}  // namespace
}  // namespace slammot::map_store
