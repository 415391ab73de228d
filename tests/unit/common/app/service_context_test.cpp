#include "common/app/service_context.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/dds.hpp"

namespace slammot::app {
namespace {

using namespace std::chrono_literals;
using slammot::testing::assign;
using slammot::testing::kForever;
using slammot::testing::PrivateBus;

slammot_Odometry odometry(const char* vehicle_id, std::int64_t stamp_ns) {
  slammot_Odometry sample{};
  assign(sample.vehicle_id, vehicle_id);
  sample.stamp_ns = stamp_ns;
  return sample;
}

struct ContextOnTheBus : ::testing::Test {
  PrivateBus bus;
  dds::Participant neighbour = bus.join();
  ServiceContext context{"example", options()};

  ServiceOptions options() const {
    ServiceOptions options;
    options.vehicle_id = "car";
    options.domain_id = bus.domain_id;
    options.dds_config = bus.config;
    return options;
  }
  /// Runs the loop until something in it stops it; a test that waits for too long fails.
  void run() {
    context.after(kForever, [this] { context.stop(99); });
    context.run();
    EXPECT_NE(context.exit_code(), 99) << "nothing came";
  }
};

TEST_F(ContextOnTheBus, HandlesSamplesOfItsOwnVehicleOnly) {
  std::vector<std::int64_t> stamps;
  context.read(dds::topics::kOdometry, Input::kSteady, [&](const slammot_Odometry& sample) {
    stamps.push_back(sample.stamp_ns);
    if (sample.stamp_ns == 3) context.stop();
  });
  dds::Writer<slammot_Odometry> writer(neighbour, dds::topics::kOdometry);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  writer.write(odometry("car", 1));
  writer.write(odometry("bus", 2));
  writer.write(odometry("car", 3));
  run();
  EXPECT_THAT(stamps, ::testing::ElementsAre(1, 3));
}

slammot_LaserScan scan_of(const char* scanner, std::uint32_t number) {
  slammot_LaserScan sample{};
  assign(sample.vehicle_id, "car");
  assign(sample.scanner_id, scanner);
  sample.sequence_number = number;
  return sample;
}

TEST_F(ContextOnTheBus, CountsScansThatNeverCame) {
  context.read(dds::topics::kLaserScan, Input::kSteady, [&](const slammot_LaserScan& scan) {
    if (scan.sequence_number == 110) context.stop();
  });
  dds::Writer<slammot_LaserScan> writer(neighbour, dds::topics::kLaserScan);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  for (const std::uint32_t number : {7U, 8U, 10U}) writer.write(scan_of("front", number));
  for (const std::uint32_t number : {3U, 110U}) writer.write(scan_of("rear", number));
  run();
  EXPECT_EQ(context.status().counter("missed_laser_scan"), 1U + 106U);
}

TEST_F(ContextOnTheBus, RefusesToPublishATopicOfAnotherService) {
  EXPECT_THROW(context.write(dds::topics::kLaserScan), std::logic_error);
  EXPECT_NO_THROW(context.write(dds::topics::kStatus));
}

TEST_F(ContextOnTheBus, WritesWithTheWriterThatReadersKnowAlready) {
  ServiceContext tracking{"tracking", options()};
  tracking.prepare_to_write(dds::topics::kScanLabels);
  dds::Reader<slammot_ScanLabels> reader(neighbour, dds::topics::kScanLabels);
  ASSERT_TRUE(reader.wait_for_writers(1, kForever));
  const auto& writer = tracking.write(dds::topics::kScanLabels);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  EXPECT_EQ(reader.matched_writers(), 1U) << "no second one";
  EXPECT_THROW(tracking.prepare_to_write(dds::topics::kLaserScan), std::logic_error);
}

TEST_F(ContextOnTheBus, BeatsAndReportsCountersLatenciesAndWhatIsMissing) {
  context.read(dds::topics::kOdometry, Input::kSteady, [](const slammot_Odometry&) {});
  context.status().counter("scans") = 12;
  context.status().latency("localize").add(3ms);
  context.status().set_trouble("database", "disk is full");
  dds::Reader<slammot_ServiceStatus> statuses(neighbour, dds::topics::kStatus);
  dds::Reader<slammot_Heartbeat> heartbeats(neighbour, dds::topics::kHeartbeat);
  context.every(50ms, [&] {
    bool has_beaten = false;
    heartbeats.take_each([&](const slammot_Heartbeat& beat) {
      EXPECT_STREQ(beat.service_name, "example");
      has_beaten = true;
    });
    bool is_complete = false;
    statuses.take_each([&](const slammot_ServiceStatus& status) {
      EXPECT_STREQ(status.vehicle_id, "car");
      EXPECT_STREQ(status.instance_name, "main");
      if (status.missing_inputs._length == 0 || status.counters._length == 0) return;
      EXPECT_EQ(status.state, slammot_SERVICE_STATE_DEGRADED);
      EXPECT_STREQ(status.explanation, "disk is full, no slammot/odometry yet");
      EXPECT_STREQ(status.missing_inputs._buffer[0].topic_name, "slammot/odometry");
      EXPECT_STREQ(status.stage_latencies._buffer[0].stage_name, "localize");
      EXPECT_EQ(status.stage_latencies._buffer[0].p99_ms, 3.0);
      is_complete = true;
    });
    if (is_complete && !has_beaten) ADD_FAILURE() << "a status without heartbeats";
    if (is_complete) context.stop();
  });
  run();
}

TEST_F(ContextOnTheBus, AnswersCommandsToItself) {
  context.on_command("finish", [](std::string_view argument) {
    return CommandResult{CommandOutcome::kDone, "finished " + std::string(argument)};
  });
  dds::Writer<slammot_Command> commands(neighbour, dds::topics::kCommand);
  dds::Reader<slammot_Reply> replies(neighbour, dds::topics::kReply);
  ASSERT_TRUE(commands.wait_for_readers(1, kForever));
  ASSERT_TRUE(replies.wait_for_writers(1, kForever));
  slammot_Command command{};
  assign(command.vehicle_id, "car");
  assign(command.service_name, "example");
  assign(command.requester, "test");
  command.request_number = 7;
  assign(command.verb, "finish");
  assign(command.argument, "it");
  commands.write(command);
  context.every(10ms, [&] {
    replies.take_each([&](const slammot_Reply& reply) {
      EXPECT_EQ(reply.request_number, 7U);
      EXPECT_STREQ(reply.requester, "test");
      EXPECT_EQ(reply.result, slammot_OUTCOME_DONE);
      EXPECT_STREQ(reply.explanation, "finished it");
      context.stop();
    });
  });
  run();
}

TEST_F(ContextOnTheBus, DoesOnceWhatIsToBeDoneOnceAndAgainWhatIsToBeDoneAgain) {
  int once = 0;
  int again = 0;
  context.after(1ms, [&] { ++once; });
  context.every(5ms, [&] {
    if (++again == 4) context.stop();
  });
  run();
  EXPECT_EQ(once, 1);
  EXPECT_EQ(again, 4);
}

slammot_TrackedObjects objects(std::uint32_t sequence) {
  slammot_TrackedObjects sample{};
  assign(sample.vehicle_id, "car");
  sample.sequence_number = sequence;
  return sample;
}

TEST_F(ContextOnTheBus, TakesTheNextWriterAtOnceWhereTheFirstHandsOver) {
  std::vector<std::uint32_t> sequences;
  context.read(dds::topics::kTrackedObjects, Input::kSteady, [&](const auto& sample) {
    sequences.push_back(sample.sequence_number);
    if (sample.sequence_number == 3) context.stop();
  });
  dds::Writer<slammot_TrackedObjects> first(neighbour, dds::topics::kTrackedObjects);
  dds::Participant other = bus.join();
  dds::Writer<slammot_TrackedObjects> second(other, dds::topics::kTrackedObjects);
  ASSERT_TRUE(first.wait_for_readers(1, kForever));
  ASSERT_TRUE(second.wait_for_readers(1, kForever));
  first.write(objects(1));
  context.after(20ms, [&] { first.hand_over(); });
  context.after(40ms, [&] { second.write(objects(3)); });
  run();
  EXPECT_THAT(sequences, ::testing::ElementsAre(1, 3));
}

TEST_F(ContextOnTheBus, EndsTheServiceBeforeItSaysThatItStops) {
  dds::Reader<slammot_Heartbeat> beats(neighbour, dds::topics::kHeartbeat);
  ASSERT_TRUE(beats.wait_for_writers(1, kForever));
  context.after(1ms, [&] { context.stop(); });
  slammot_ServiceState at_the_end = slammot_SERVICE_STATE_STOPPING;
  const auto newest = [&](const slammot_Heartbeat& beat) { at_the_end = beat.state; };
  context.run([&] { beats.take_each(newest); });
  EXPECT_NE(at_the_end, slammot_SERVICE_STATE_STOPPING);
  const auto end = std::chrono::steady_clock::now() + kForever;
  while (at_the_end != slammot_SERVICE_STATE_STOPPING && std::chrono::steady_clock::now() < end)
    beats.take_each(newest);
  EXPECT_EQ(at_the_end, slammot_SERVICE_STATE_STOPPING);
}

TEST_F(ContextOnTheBus, StopsAtOnceOnRequestWhereNoMomentIsBetter) {
  context.after(0ms, [this] {
    context.request_stop();
    context.after(0ms, [this] { context.stop(1); });
  });
  run();
  EXPECT_EQ(context.exit_code(), 0);
}

TEST_F(ContextOnTheBus, StopsOnRequestAtTheNextMomentBetweenScans) {
  context.stop_between_scans();
  EXPECT_FALSE(context.may_stop_now());
  bool came = false;
  context.after(0ms, [this] { context.request_stop(); });
  context.after(20ms, [&] { came = context.may_stop_now(); });
  run();
  EXPECT_TRUE(came);
}

TEST_F(ContextOnTheBus, StopsOnRequestAlsoWhereNoScansCome) {
  context.stop_between_scans();
  context.every(10ms, [] {});
  const auto begin = std::chrono::steady_clock::now();
  context.after(0ms, [this] { context.request_stop(); });
  run();
  EXPECT_GE(std::chrono::steady_clock::now() - begin, StopRequest::kLongestWait);
}

TEST_F(ContextOnTheBus, StopsWithTheExitCodeItWasGiven) {
  context.after(1ms, [&] { context.stop(3); });
  run();
  EXPECT_EQ(context.exit_code(), 3);
}

}  // namespace
}  // namespace slammot::app
