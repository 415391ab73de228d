#include "common/wire/service.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

const ServiceName kName{"car", "detection", "front"};

void expect_same(const ServiceName& a, const ServiceName& b) {
  EXPECT_EQ(a.vehicle_id, b.vehicle_id);
  EXPECT_EQ(a.service, b.service);
  EXPECT_EQ(a.instance, b.instance);
}

TEST(HeartbeatOnTheWire, ComesBackAsItWas) {
  const Heartbeat beat{kName, 123, 4, 5, ServiceState::kDegraded};
  const auto back = decode(encode(beat));
  ASSERT_TRUE(back);
  expect_same(back->name, kName);
  EXPECT_EQ(back->stamp_ns, 123);
  EXPECT_EQ(back->sequence, 4U);
  EXPECT_EQ(back->process_number, 5U);
  EXPECT_EQ(back->state, ServiceState::kDegraded);
}

TEST(HeartbeatOnTheWire, IsRefusedInAnUnknownState) {
  slammot_Heartbeat sample = encode(Heartbeat{});
  sample.state = static_cast<slammot_ServiceState>(4);
  EXPECT_NE(decode(sample).fault(), "");
}

struct StatusOnTheWire : ::testing::Test {
  ServiceStatus status{.name = kName,
                       .stamp_ns = 123,
                       .started_ns = 45,
                       .version = "0.1.0",
                       .state = ServiceState::kRunning,
                       .explanation = "because",
                       .missing_inputs = {{"slammot/odometry", -1.0}},
                       .counters = {{"scans", 1000}, {"duplicates", 2}},
                       .latencies = {{"detect", 1000, 0.1, 0.4, 2.0}}};
  StatusEncoder encoder;
};

TEST_F(StatusOnTheWire, ComesBackAsItWas) {
  const auto back = decode(encoder.encode(status));
  ASSERT_TRUE(back) << back.fault();
  expect_same(back->name, kName);
  EXPECT_EQ(back->stamp_ns, 123);
  EXPECT_EQ(back->started_ns, 45);
  EXPECT_EQ(back->version, "0.1.0");
  EXPECT_EQ(back->state, ServiceState::kRunning);
  EXPECT_EQ(back->explanation, "because");
  ASSERT_EQ(back->missing_inputs.size(), 1U);
  EXPECT_EQ(back->missing_inputs[0].topic, "slammot/odometry");
  EXPECT_EQ(back->missing_inputs[0].silent_s, -1.0);
  ASSERT_EQ(back->counters.size(), 2U);
  EXPECT_EQ(back->counters[1].name, "duplicates");
  EXPECT_EQ(back->counters[1].total, 2U);
  ASSERT_EQ(back->latencies.size(), 1U);
  EXPECT_EQ(back->latencies[0].stage, "detect");
  EXPECT_EQ(back->latencies[0].calls, 1000U);
  EXPECT_EQ(back->latencies[0].p50_ms, 0.1);
  EXPECT_EQ(back->latencies[0].p99_ms, 0.4);
  EXPECT_EQ(back->latencies[0].highest_ms, 2.0);
}

TEST_F(StatusOnTheWire, IsCutWhereItDoesNotFit) {
  status.explanation = std::string(1000, 'x');
  status.counters.assign(200, {"a", 1});
  const auto back = decode(encoder.encode(status));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->explanation.size(), 256U);
  EXPECT_EQ(back->counters.size(), 128U);
}

TEST_F(StatusOnTheWire, IsRefusedWhereItIsUnsound) {
  const auto fault_after = [&](auto corrupt) {
    slammot_ServiceStatus corrupted = encoder.encode(status);
    corrupt(corrupted);
    return decode(corrupted).fault();
  };
  EXPECT_NE(fault_after([](auto& s) { s.state = static_cast<slammot_ServiceState>(4); }), "");
  EXPECT_NE(fault_after([](auto& s) { s.missing_inputs._buffer[0].silent_s = testing::kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.stage_latencies._buffer[0].p99_ms = testing::kNan; }), "");
}

TEST(CommandOnTheWire, ComesBackAsItWas) {
  const Command command{"car", "localization", "slammot-77", 9, "finish_submap", "now"};
  const auto back = decode(encode(command));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->vehicle_id, "car");
  EXPECT_EQ(back->service, "localization");
  EXPECT_EQ(back->requester, "slammot-77");
  EXPECT_EQ(back->request_number, 9U);
  EXPECT_EQ(back->verb, "finish_submap");
  EXPECT_EQ(back->argument, "now");
}

TEST(CommandOnTheWire, IsRefusedWithoutAVerb) { EXPECT_NE(decode(encode(Command{})).fault(), ""); }

TEST(ReplyOnTheWire, ComesBackAsItWas) {
  const Reply reply{"car", "slammot-77", 9, "localization", Outcome::kRefused, "no submap in use"};
  const auto back = decode(encode(reply));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->vehicle_id, "car");
  EXPECT_EQ(back->requester, "slammot-77");
  EXPECT_EQ(back->request_number, 9U);
  EXPECT_EQ(back->service, "localization");
  EXPECT_EQ(back->outcome, Outcome::kRefused);
  EXPECT_EQ(back->explanation, "no submap in use");
}

TEST(ReplyOnTheWire, IsRefusedWithAnUnknownResult) {
  slammot_Reply sample = encode(Reply{});
  sample.result = static_cast<slammot_Outcome>(3);
  EXPECT_NE(decode(sample).fault(), "");
}

}  // namespace
}  // namespace slammot::wire
