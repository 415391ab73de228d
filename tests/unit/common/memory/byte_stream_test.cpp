#include "common/memory/byte_stream.hpp"

#include <span>

#include <gtest/gtest.h>

namespace slammot::memory {
namespace {

std::vector<std::byte> example() {
  std::vector<std::byte> bytes;
  put(bytes, std::int64_t{-7});
  put(bytes, Eigen::Matrix3d(Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal()));
  put_all(bytes, std::vector<std::uint16_t>{4, 5, 6});
  put_all(bytes, std::vector<double>{});
  return bytes;
}

struct Example {
  std::int64_t number = 0;
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  std::vector<std::uint16_t> some;
  std::vector<double> none = {1.0};
};

Example read(ByteReader& from) {
  Example values;
  from.get(values.number);
  from.get(values.matrix);
  from.get_all(values.some);
  from.get_all(values.none);
  return values;
}

TEST(ByteStream, GivesBackWhatWasPut) {
  const auto bytes = example();
  ByteReader from(bytes);
  const Example values = read(from);
  EXPECT_TRUE(from.ok());
  EXPECT_TRUE(from.at_end());
  EXPECT_EQ(values.number, -7);
  EXPECT_EQ(values.matrix, Eigen::Matrix3d(Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal()));
  EXPECT_EQ(values.some, (std::vector<std::uint16_t>{4, 5, 6}));
  EXPECT_TRUE(values.none.empty());
}

TEST(ByteStream, GivesBackOptionalValues) {
  std::vector<std::byte> bytes;
  put(bytes, std::optional<std::int64_t>(5));
  put(bytes, std::optional<double>());
  ByteReader from(bytes);
  std::optional<std::int64_t> number;
  std::optional<double> nothing = 3.0;
  from.get(number);
  from.get(nothing);
  EXPECT_TRUE(from.ok() && from.at_end());
  EXPECT_EQ(number, 5);
  EXPECT_FALSE(nothing);
}

TEST(ByteStream, IsNotOkWhereverItIsCut) {
  const auto bytes = example();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ByteReader from(std::span<const std::byte>(bytes).first(size));
    read(from);
    EXPECT_FALSE(from.ok()) << size;
  }
}

TEST(ByteStream, RefusesACountThatTheBytesCannotHold) {
  std::vector<std::byte> bytes;
  put(bytes, std::uint64_t{1} << 61);
  put(bytes, 1.0);
  ByteReader from(bytes);
  std::vector<double> values = {2.0};
  from.get_all(values);
  EXPECT_FALSE(from.ok());
  EXPECT_EQ(values, std::vector<double>{2.0});
}

std::vector<std::int8_t> read_cells(std::span<const std::byte> bytes, std::size_t most, bool& ok) {
  ByteReader from(bytes);
  std::vector<std::int8_t> cells;
  from.get_cells(cells, most);
  ok = from.ok() && from.at_end();
  return cells;
}

TEST(ByteStream, GivesBackCells) {
  std::vector<std::int8_t> sparse(10'000, 0);
  for (const std::size_t i : {3U, 5U, 21U, 22U, 5000U, 9999U})
    sparse[i] = static_cast<std::int8_t>(-7);
  for (const auto& cells :
       {sparse, std::vector<std::int8_t>(1000, 1), std::vector<std::int8_t>(1000, 0),
        std::vector<std::int8_t>{}, std::vector<std::int8_t>{0}}) {
    std::vector<std::byte> bytes;
    put_cells(bytes, cells);
    bool ok = false;
    EXPECT_EQ(read_cells(bytes, cells.size(), ok), cells);
    EXPECT_TRUE(ok);
  }
  std::vector<std::byte> bytes;
  put_cells(bytes, sparse);
  EXPECT_LT(bytes.size(), 200U);
}

TEST(ByteStream, RefusesCellsThatCannotBeRight) {
  bool ok = true;
  std::vector<std::byte> bytes;
  put_cells(bytes, std::vector<std::int8_t>(100, 1));
  read_cells(bytes, 99, ok);
  EXPECT_FALSE(ok) << "more than there can be";
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    read_cells(std::span<const std::byte>(bytes).first(size), 100, ok);
    EXPECT_FALSE(ok) << "cut after " << size;
  }
  const std::uint64_t huge = ~std::uint64_t{0};
  for (const auto& [zeros, others] :
       {std::pair<std::uint64_t, std::uint64_t>{0, 0}, {0, 101}, {101, 0}, {huge, 1}, {1, huge}}) {
    std::vector<std::byte> made;
    put(made, std::uint64_t{100});
    put(made, zeros);
    put(made, others);
    made.resize(made.size() + 200);
    read_cells(made, 100, ok);
    EXPECT_FALSE(ok) << zeros << " zeros, " << others << " others";
  }
}

TEST(ByteStream, ReadsNothingMoreOnceItHasFailed) {
  std::vector<std::byte> bytes;
  put(bytes, std::uint8_t{9});
  ByteReader from(bytes);
  std::uint64_t wide = 1;
  std::uint8_t narrow = 2;
  from.get(wide);
  from.get(narrow);
  EXPECT_FALSE(from.ok());
  EXPECT_EQ(wide, 1U);
  EXPECT_EQ(narrow, 2U);
}

TEST(ByteStream, TakesAnyByteForABool) {
  const std::vector<std::byte> bytes = {std::byte{0}, std::byte{1}, std::byte{200}};
  ByteReader from(bytes);
  bool values[3] = {true, false, false};
  for (bool& value : values) from.get(value);
  EXPECT_FALSE(values[0]);
  EXPECT_TRUE(values[1]);
  EXPECT_TRUE(values[2]);
}

TEST(Unsealed, GivesWhatWasSealed) {
  auto bytes = example();
  const std::size_t size = bytes.size();
  put(bytes, checksum(bytes));
  ASSERT_TRUE(unsealed(bytes));
  EXPECT_EQ(unsealed(bytes)->size(), size);
}

TEST(Unsealed, RefusesEveryChangedBitAndEveryCut) {
  auto bytes = example();
  put(bytes, checksum(bytes));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto flip = std::byte{static_cast<unsigned char>(1U << bit % 8)};
    bytes[bit / 8] ^= flip;
    EXPECT_FALSE(unsealed(bytes)) << bit;
    bytes[bit / 8] ^= flip;
  }
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(unsealed(std::span<const std::byte>(bytes).first(size))) << size;
}

}  // namespace
}  // namespace slammot::memory
