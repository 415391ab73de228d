#include "common/dds/writer.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using namespace std::chrono_literals;
using slammot::testing::assign;
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

}  // namespace
}  // namespace slammot::dds
