#include "common/memory/recycling_queue.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::memory {
namespace {

std::vector<int> values(const RecyclingQueue<int>& queue) {
  std::vector<int> all;
  for (const int value : queue.all()) all.push_back(value);
  return all;
}

TEST(RecyclingQueue, IsFirstInFirstOut) {
  RecyclingQueue<int> queue;
  EXPECT_TRUE(queue.empty());
  for (int i = 0; i < 5; ++i) queue.push_back() = i;
  queue.pop_front();
  queue.pop_front();
  for (int i = 5; i < 11; ++i)
    queue.push_back() = i;  // grows while it begins in the middle of its places
  queue.pop_back();
  EXPECT_EQ(values(queue), (std::vector<int>{2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(queue.front(), 2);
  EXPECT_EQ(queue.back(), 9);
  EXPECT_EQ(queue[3], 5);
  queue.clear();
  EXPECT_TRUE(queue.empty());
  EXPECT_TRUE(values(queue).empty());
}

TEST(RecyclingQueue, HandsOutThePlacesOfWhatWasTakenOut) {
  RecyclingQueue<std::vector<int>> queue(3);
  std::vector<const int*> memory;
  for (int i = 0; i < 3; ++i) {
    queue.push_back().assign(10, i);
    memory.push_back(queue.back().data());
  }
  for (int i = 3; i < 20; ++i) {
    queue.pop_front();
    std::vector<int>& place = queue.push_back();
    place.assign(10, i);
    EXPECT_EQ(place.data(), memory[static_cast<std::size_t>(i) % 3]);
  }
  EXPECT_EQ(queue.front().front(), 17);
}

TEST(RecyclingQueue, KeepsWhatItsElementsOwnWhenItGrows) {
  RecyclingQueue<std::string> queue;
  for (int i = 0; i < 100; ++i) {
    queue.push_back() = std::string(50, static_cast<char>('a' + i % 26));
    if (i % 3 == 0) queue.pop_front();
  }
  ASSERT_EQ(queue.size(), 66U);
  for (std::size_t i = 0; i < queue.size(); ++i)
    EXPECT_EQ(queue[i], std::string(50, static_cast<char>('a' + (i + 34) % 26)));
}

}  // namespace
}  // namespace slammot::memory
