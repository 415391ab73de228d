#include "services/gateway/protocol.hpp"

#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace slammot::gateway {
namespace {

template <typename Expected>
const Expected* as(const ClientMessage& message) {
  return std::get_if<Expected>(&message);
}

TEST(Protocol, ChoosesTheFirstSubprotocolThatItSpeaks) {
  EXPECT_EQ(choose_subprotocol("x, foxglove.websocket.v1 ,foxglove.sdk.v1"),
            "foxglove.websocket.v1");
  EXPECT_EQ(choose_subprotocol("foxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(choose_subprotocol(" , foxglove.sdk.v9,"), "");
}

TEST(Protocol, WritesTheHeaderOfDataInLittleEndian) {
  const DataHeader expected = {1, 4, 3, 2, 1, 8, 7, 6, 5, 4, 3, 2, 1};
  EXPECT_EQ(data_header(0x01020304, 0x0102030405060708), expected);
}

TEST(Protocol, ReadsSubscriptions) {
  const ClientMessage message = parse_client_message(
      R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1},{"id":8,"channelId":3}]})");
  ASSERT_NE(as<Subscribe>(message), nullptr);
  ASSERT_EQ(as<Subscribe>(message)->subscriptions.size(), 2U);
  EXPECT_EQ(as<Subscribe>(message)->subscriptions[1].id, 8U);
  EXPECT_EQ(as<Subscribe>(message)->subscriptions[1].channel, ChannelId::kPose);
}

TEST(Protocol, RefusesWhatItDoesNotServe) {
  for (const char* text :
       {"", "[]", "{}", R"({"op":3})", R"({"op":"setParameters"})", R"({"op":"subscribe"})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":99}]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[3]})",
        R"({"op":"unsubscribe","subscriptionIds":["a"]})"})
    EXPECT_NE(as<Refused>(parse_client_message(text)), nullptr) << text;
}

TEST(Protocol, SurvivesAnyBytes) {
  std::mt19937 random(7);
  const std::string sound =
      R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1},{"id":8,"channelId":3}]})";
  for (int trial = 0; trial < 5000; ++trial) {
    std::string text = sound;
    for (int change = 0; change < 4; ++change)
      text[random() % text.size()] = static_cast<char>(random());
    parse_client_message(text);
  }
}

TEST(Protocol, AdvertisesEveryChannelWithItsSchema) {
  const auto message = nlohmann::json::parse(advertisement(channels()));
  ASSERT_EQ(message["channels"].size(), kChannelCount);
  for (std::size_t i = 0; i < kChannelCount; ++i) {
    EXPECT_EQ(message["channels"][i]["id"], i);
    EXPECT_FALSE(message["channels"][i]["schema"].get<std::string>().empty());
  }
}

}  // namespace
}  // namespace slammot::gateway
