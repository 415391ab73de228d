#include "common/app/interface_watch.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

struct WatchedInterface : ::testing::Test {
  std::string identity = "7 10.0.0.2";
  InterfaceWatch watch{[this] { return identity; }};
};

TEST_F(WatchedInterface, StaysTheSameWhileNothingHappens) {
  EXPECT_FALSE(watch.was_replaced());
  EXPECT_FALSE(watch.was_replaced());
}

TEST_F(WatchedInterface, IsReplacedOnceItIsBack) {
  identity = "";
  EXPECT_FALSE(watch.was_replaced());  // a process that starts now does not find it
  identity = "7 10.0.0.2";
  EXPECT_TRUE(watch.was_replaced());
}

TEST_F(WatchedInterface, IsReplacedBetweenTwoLooks) {
  identity = "8 10.0.0.2";
  EXPECT_TRUE(watch.was_replaced());
}

TEST_F(WatchedInterface, IsReplacedByAnotherAddress) {
  identity = "7 10.0.0.9";
  EXPECT_TRUE(watch.was_replaced());
}

TEST(IdentityOfInterface, IsThatOfTheKernel) {
  EXPECT_EQ(identity_of_interface("lo"), "1 127.0.0.1");
  EXPECT_EQ(identity_of_interface("none-such"), "");
}

}  // namespace
}  // namespace slammot::app
