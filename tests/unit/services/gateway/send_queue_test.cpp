#include "services/gateway/send_queue.hpp"

#include <gtest/gtest.h>

namespace slammot::gateway {
namespace {

Outgoing data(std::size_t bytes, std::uint32_t number = 0) {
  return {data_header(number, 0), std::make_shared<const std::string>(bytes, 'x')};
}
Outgoing control() { return {std::nullopt, std::make_shared<const std::string>("{}")}; }

TEST(SendQueue, DropsTheOldestDataBeyondItsBytes) {
  SendQueue queue({.most_bytes = 1000, .most_messages = 100, .most_control_messages = 4});
  queue.push(control());
  for (std::uint32_t i = 0; i < 50; ++i) queue.push(data(100, i));
  EXPECT_LE(queue.bytes(), 1000U);
  EXPECT_EQ(queue.dropped(), 42U);
  EXPECT_FALSE(queue.pop().header);  // what controls the connection stays, in order
  EXPECT_EQ(queue.pop().header, data_header(42, 0));
}

TEST(SendQueue, DropsTheOldestDataBeyondItsNumber) {
  SendQueue queue({.most_bytes = 1000000, .most_messages = 3, .most_control_messages = 4});
  for (std::uint32_t i = 0; i < 5; ++i) queue.push(data(1, i));
  EXPECT_EQ(queue.dropped(), 2U);
  EXPECT_EQ(queue.pop().header, data_header(2, 0));
}

TEST(SendQueue, KeepsOneMessageLargerThanItsBytes) {
  SendQueue queue({.most_bytes = 10, .most_messages = 3, .most_control_messages = 4});
  queue.push(data(1000));
  EXPECT_FALSE(queue.empty());
  queue.pop();
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.bytes(), 0U);
}

TEST(SendQueue, GivesUpAClientThatLetsControlMessagesPileUp) {
  SendQueue queue({.most_bytes = 10, .most_messages = 3, .most_control_messages = 2});
  EXPECT_EQ(queue.push(control()), SendQueue::Pushed::kKept);
  EXPECT_EQ(queue.push(control()), SendQueue::Pushed::kKept);
  EXPECT_EQ(queue.push(control()), SendQueue::Pushed::kGaveUp);
}

}  // namespace
}  // namespace slammot::gateway
