#include "common/dds/writer.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "common/dds/reader.hpp"
#include "common/dds/wait_set.hpp"
#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using namespace std::chrono_literals;
using slammot::testing::assign;
using slammot::testing::kForever;
using slammot::testing::PrivateBus;

TEST(Writer, RefusesASampleThatBreaksItsTypesLimits) {
  const PrivateBus bus;
  const Participant participant = bus.join();
  Writer<slammot_LaserScan> writer(participant, topics::kLaserScan);
  std::vector<float> too_many(4097);
  slammot_LaserScan scan{};
  assign(scan.vehicle_id, "car");
  scan.ranges_m = {4097, 4097, too_many.data(), false};
  EXPECT_THROW(writer.write(scan), Error);
  EXPECT_EQ(writer.counters().written, 0U);
}

TEST(Writer, SaysThatNoReaderCame) {
  const PrivateBus bus;
  const Participant participant = bus.join();
  const Writer<slammot_Odometry> writer(participant, topics::kOdometry);
  EXPECT_FALSE(writer.wait_for_readers(1, 1ms));
}

TEST(Writer, HandsOverAKeyThatADeadProcessStillHas) {
  const PrivateBus bus;
  const Participant leading = bus.join();
  const Participant dead_process = bus.join();
  const Participant reading = bus.join();
  Writer<slammot_TrackedObjects> leader(leading, topics::kTrackedObjects);
  Writer<slammot_TrackedObjects> dead(dead_process, topics::kTrackedObjects);
  Reader<slammot_TrackedObjects> reader(reading, topics::kTrackedObjects);
  ASSERT_TRUE(reader.wait_for_writers(2, kForever));
  slammot_TrackedObjects sample{};
  assign(sample.vehicle_id, "car");
  for (auto* writer : {&leader, &dead}) {
    writer->write(sample);
    ASSERT_TRUE(writer->wait_for_acknowledgements(kForever));
  }
  bool has_ended = false;
  WaitSet wait_set(reading);
  wait_set.on_data(reader, [&] {
    reader.take_each([](const slammot_TrackedObjects&) {},
                     [&](const SampleInfo&) { has_ended = true; });
  });
  leader.hand_over();
  while (!has_ended && wait_set.wait(kForever) == WaitSet::Wake::kHandled) {}
  EXPECT_TRUE(has_ended);
}

}  // namespace
}  // namespace slammot::dds
