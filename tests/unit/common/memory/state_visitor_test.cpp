#include "common/memory/state_visitor.hpp"

#include <gtest/gtest.h>

namespace slammot::memory {
namespace {

enum class Colour : std::uint8_t { kRed, kGreen };

class Hidden {
 public:
  static void visit_state(auto& self, auto& visit) { visit(self.number_); }
  int number_ = 0;
  bool operator==(const Hidden&) const = default;
};

struct Example {
  Colour colour = Colour::kRed;
  bool is_set = false;
  Eigen::Vector2d vector = Eigen::Vector2d::Zero();
  Eigen::MatrixXd matrix;
  std::optional<std::int64_t> stamp;
  std::variant<float, Hidden> either;
  std::vector<Eigen::Vector2d> points;
  std::vector<Hidden> hidden;
  RecyclingQueue<int> queue;
  std::map<std::pair<int, int>, double> by_pair;
  std::string name;
  std::array<bool, 2> flags = {};
};

struct Parts {
  static constexpr Colour largest(Colour) { return Colour::kGreen; }
  static void visit(auto& visit, Like<Example> auto& example) {
    auto& [colour, is_set, vector, matrix, stamp, either, points, hidden, queue, by_pair, name,
           flags] = example;
    visit(colour, is_set, vector, matrix, stamp, either, points, hidden, queue, by_pair, name,
          flags);
  }
};

Example example() {
  Example some;
  some.colour = Colour::kGreen;
  some.is_set = true;
  some.vector = {1.0, 2.0};
  some.matrix = Eigen::MatrixXd::Identity(2, 3);
  some.stamp = 17;
  some.either = Hidden{4};
  some.points = {{1.0, 2.0}, {3.0, 4.0}};
  some.hidden = {{1}, {2}};
  some.queue.push_back() = 5;
  some.queue.push_back() = 6;
  some.by_pair = {{{1, 2}, 0.5}, {{2, 3}, 0.7}};
  some.name = "front";
  some.flags = {true, false};
  return some;
}

std::vector<std::byte> saved(const Example& example) {
  std::vector<std::byte> bytes;
  StateSaver saver(bytes);
  StateVisitor<Parts, StateSaver> visit(saver);
  visit(example);
  return bytes;
}

/// False if the bytes are refused or not used up.
bool load(std::span<const std::byte> bytes, Example& example) {
  ByteReader from(bytes);
  StateLoader loader(from);
  StateVisitor<Parts, StateLoader> visit(loader);
  visit(example);
  return from.ok() && from.at_end();
}

TEST(StateVisitor, LoadsWhatWasSavedOverAnythingElse) {
  Example loaded;
  loaded.queue.push_back() = 9;
  loaded.by_pair[{7, 7}] = 1.0;
  loaded.stamp = 3;
  ASSERT_TRUE(load(saved(example()), loaded));
  const Example wanted = example();
  EXPECT_EQ(loaded.colour, wanted.colour);
  EXPECT_EQ(loaded.vector, wanted.vector);
  EXPECT_EQ(loaded.matrix, wanted.matrix);
  EXPECT_EQ(loaded.stamp, wanted.stamp);
  EXPECT_EQ(loaded.either, wanted.either);
  EXPECT_EQ(loaded.points, wanted.points);
  EXPECT_EQ(loaded.hidden, wanted.hidden);
  EXPECT_EQ(loaded.by_pair, wanted.by_pair);
  EXPECT_EQ(loaded.name, wanted.name);
  EXPECT_EQ(saved(loaded), saved(wanted)) << "the rest, too";
}

TEST(StateVisitor, LoadsEmptyValuesOverOthers) {
  Example loaded = example();
  ASSERT_TRUE(load(saved({}), loaded));
  EXPECT_EQ(saved(loaded), saved({}));
}

TEST(StateVisitor, RefusesEveryCut) {
  const auto bytes = saved(example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Example loaded;
    EXPECT_FALSE(load(std::span(bytes).first(size), loaded)) << size;
  }
}

TEST(StateVisitor, RefusesAnUnknownValueOfAnEnumeration) {
  auto bytes = saved(example());
  bytes.front() = std::byte{2};
  Example loaded;
  EXPECT_FALSE(load(bytes, loaded));
}

}  // namespace
}  // namespace slammot::memory
