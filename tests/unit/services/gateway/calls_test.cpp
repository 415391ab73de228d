#include "services/gateway/calls.hpp"

#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace slammot::gateway {
namespace {

/// Service 3 is /player/seek.
std::string request(std::uint8_t service, const std::string& payload) {
  std::string bytes = {2, static_cast<char>(service), 0, 0, 0, 9, 0, 0, 0, 4, 0, 0, 0};
  return bytes + "json" + payload;
}

TEST(Calls, AreReadWithTheirArgument) {
  const auto call = parse_service_call(request(3, R"({"seconds":12.5})"));
  ASSERT_TRUE(call);
  EXPECT_EQ(call->service, 3U);
  EXPECT_EQ(call->call, 9U);
  EXPECT_EQ(call->argument, "12.5");
  EXPECT_EQ(callable_services()[call->service].name, "/player/seek");
}

TEST(Calls, WithoutArgumentNeedNone) {
  const auto call = parse_service_call(request(0, ""));
  ASSERT_TRUE(call);
  EXPECT_EQ(call->argument, "");
}

TEST(Calls, AreRefusedWhereTheyAskForNothingThatIsServed) {
  EXPECT_FALSE(parse_service_call(""));
  EXPECT_FALSE(parse_service_call(request(99, "{}")));
  EXPECT_FALSE(parse_service_call(request(3, "{}")));
  EXPECT_FALSE(parse_service_call(request(3, R"({"seconds":"now"})")));
  EXPECT_FALSE(parse_service_call(request(3, R"({"seconds":1)")));
}

TEST(Calls, SurviveAnyBytes) {
  std::mt19937 random(7);
  const std::string sound = request(3, R"({"seconds":12.5})");
  for (int trial = 0; trial < 5000; ++trial) {
    std::string bytes = sound.substr(0, random() % (sound.size() + 1));
    for (int change = 0; change < 3 && !bytes.empty(); ++change)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    if (const auto call = parse_service_call(bytes))
      EXPECT_LT(call->service, callable_services().size());
  }
}

TEST(Calls, AreAnsweredByNumber) {
  EXPECT_EQ(service_response({3, 9, ""}),
            std::string({3, 3, 0, 0, 0, 9, 0, 0, 0, 4, 0, 0, 0}) + "json{}");
  const auto failure = nlohmann::json::parse(call_failure({3, 9, ""}, "no answer"));
  EXPECT_EQ(failure["op"], "serviceCallFailure");
  EXPECT_EQ(failure["callId"], 9);
  EXPECT_EQ(failure["message"], "no answer");
}

TEST(Calls, AreAdvertisedInTheOrderOfTheirIds) {
  const auto message = nlohmann::json::parse(services_advertisement());
  ASSERT_EQ(message["services"].size(), callable_services().size());
  for (std::size_t i = 0; i < callable_services().size(); ++i) {
    EXPECT_EQ(callable_services()[i].id, i);
    EXPECT_EQ(message["services"][i]["name"], callable_services()[i].name);
  }
}

}  // namespace
}  // namespace slammot::gateway
