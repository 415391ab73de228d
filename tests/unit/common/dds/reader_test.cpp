#include "common/dds/reader.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/dds/wait_set.hpp"
#include "common/dds/writer.hpp"
#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using slammot::testing::assign;
using slammot::testing::kForever;
using slammot::testing::PrivateBus;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

slammot_Odometry odometry(std::int64_t stamp_ns) {
  slammot_Odometry sample{};
  assign(sample.vehicle_id, "car");
  sample.stamp_ns = stamp_ns;
  return sample;
}

slammot_Constraint constraint(std::uint32_t from, std::uint32_t to) {
  slammot_Constraint sample{};
  assign(sample.vehicle_id, "car");
  sample.from_submap_id = from;
  sample.to_submap_id = to;
  return sample;
}

struct OdometryOverTheBus : ::testing::Test {
  PrivateBus bus;
  Participant writing = bus.join("writing");
  Participant reading = bus.join("reading");
  Writer<slammot_Odometry> writer{writing, topics::kOdometry};

  void write(std::int64_t first, std::int64_t last) {
    for (std::int64_t stamp = first; stamp <= last; ++stamp) {
      ASSERT_EQ(writer.write(odometry(stamp)), WriteResult::kWritten);
    }
    ASSERT_TRUE(writer.wait_for_acknowledgements(kForever));
  }

  static std::vector<std::int64_t> take_stamps(Reader<slammot_Odometry>& reader) {
    std::vector<std::int64_t> stamps;
    reader.take_each([&](const slammot_Odometry& sample) { stamps.push_back(sample.stamp_ns); });
    return stamps;
  }
};

TEST_F(OdometryOverTheBus, ComesInTheOrderInWhichItWasWritten) {
  Reader<slammot_Odometry> reader(reading, topics::kOdometry);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  write(1, 3);
  EXPECT_THAT(take_stamps(reader), ElementsAre(1, 2, 3));
  EXPECT_THAT(take_stamps(reader), IsEmpty());
  EXPECT_EQ(reader.counters().taken, 3U);
  EXPECT_EQ(writer.counters().written, 3U);
}

TEST_F(OdometryOverTheBus, IsVolatileForALateJoiner) {
  write(1, 3);
  Reader<slammot_Odometry> reader(reading, topics::kOdometry);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  write(4, 4);
  EXPECT_THAT(take_stamps(reader), ElementsAre(4));
}

TEST_F(OdometryOverTheBus, IsKeptForAServiceThatIsRestarted) {
  write(1, 500);
  Reader<slammot_Odometry> reader(reading, topics::kOdometry, History::kRestart);
  std::vector<std::int64_t> stamps;
  WaitSet wait_set(reading);
  wait_set.on_data(reader, [&] {
    reader.take_each([&](const slammot_Odometry& sample) { stamps.push_back(sample.stamp_ns); });
  });
  while ((stamps.empty() || stamps.back() < 500) &&
         wait_set.wait(kForever) == WaitSet::Wake::kHandled) {}
  ASSERT_EQ(stamps.size(), 400U);
  EXPECT_EQ(stamps.front(), 101);
}

TEST_F(OdometryOverTheBus, KeepsTheNewestForAReaderThatSleeps) {
  Reader<slammot_Odometry> reader(reading, topics::kOdometry);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  write(1, 50);
  const auto stamps = take_stamps(reader);
  ASSERT_EQ(stamps.size(), 20U);
  EXPECT_EQ(stamps.front(), 31);
  EXPECT_EQ(stamps.back(), 50);
}

TEST_F(OdometryOverTheBus, IsAllThereForARecorder) {
  Reader<slammot_Odometry> recorder(reading, topics::kOdometry, History::kRecorder);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  write(1, 1000);
  EXPECT_EQ(take_stamps(recorder).size(), 1000U);
  EXPECT_EQ(recorder.counters().lost, 0U);
  EXPECT_EQ(recorder.counters().rejected, 0U);
}

TEST_F(OdometryOverTheBus, StaysReadableAsLongAsTheLoanLives) {
  Reader<slammot_Odometry> reader(reading, topics::kOdometry);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  write(1, 1);
  const Loan<slammot_Odometry> first = reader.take();
  write(2, 2);
  const Loan<slammot_Odometry> second = reader.take();
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(first[0].stamp_ns, 1);
  EXPECT_EQ(second[0].stamp_ns, 2);
  EXPECT_TRUE(first.info(0).has_value);
  EXPECT_EQ(first.info(0).writer_handle, second.info(0).writer_handle);
}

TEST_F(OdometryOverTheBus, GivesEveryLoanBack) {
  Reader<slammot_Odometry> reader(reading, topics::kOdometry);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  // The sanitizer presets see a loan that is not returned as a leak.
  for (int round = 0; round < 100; ++round) {
    write(round, round);
    ASSERT_EQ(take_stamps(reader).size(), 1U);
  }
}

struct ConstraintsOverTheBus : ::testing::Test {
  PrivateBus bus;
  Participant writing = bus.join("writing");
  Participant reading = bus.join("reading");
  Writer<slammot_Constraint> writer{writing, topics::kConstraint};

  std::vector<std::uint32_t> take_targets(Reader<slammot_Constraint>& reader, std::size_t count) {
    std::vector<std::uint32_t> targets;
    WaitSet wait_set(reading);
    wait_set.on_data(reader, [&] {
      reader.take_each(
          [&](const slammot_Constraint& sample) { targets.push_back(sample.to_submap_id); });
    });
    while (targets.size() < count && wait_set.wait(kForever) == WaitSet::Wake::kHandled) {}
    return targets;
  }
};

TEST_F(ConstraintsOverTheBus, AreAllThereForALateJoiner) {
  for (std::uint32_t to = 1; to <= 3; ++to) writer.write(constraint(0, to));
  Reader<slammot_Constraint> late(reading, topics::kConstraint);
  EXPECT_THAT(take_targets(late, 3), UnorderedElementsAre(1, 2, 3));
}

TEST_F(ConstraintsOverTheBus, AreNotKeptForLateJoinersAfterTheirEnd) {
  writer.write(constraint(0, 1));
  writer.write(constraint(0, 2));
  writer.end(constraint(0, 1));
  Reader<slammot_Constraint> late(reading, topics::kConstraint);
  EXPECT_THAT(take_targets(late, 1), ElementsAre(2));
  EXPECT_TRUE(writer.wait_for_acknowledgements(kForever));
  EXPECT_THAT(late.take_each([](const slammot_Constraint&) {}), 0U);
}

TEST_F(ConstraintsOverTheBus, TellReadersOfTheirEnd) {
  Reader<slammot_Constraint> reader(reading, topics::kConstraint);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  writer.write(constraint(0, 1));
  ASSERT_THAT(take_targets(reader, 1), ElementsAre(1));
  writer.end(constraint(0, 1));
  ASSERT_TRUE(writer.wait_for_acknowledgements(kForever));
  const Loan<slammot_Constraint> loan = reader.take();
  ASSERT_EQ(loan.size(), 1U);
  EXPECT_FALSE(loan.info(0).has_value);
  EXPECT_EQ(loan[0].to_submap_id, 1U);
}

TEST(Reader, NamesThePolicyThatKeepsItFromAWriter) {
  const PrivateBus bus;
  const Participant writing = bus.join("writing");
  const Participant reading = bus.join("reading");
  // The same topic, but its writer takes it for something that late joiners do not get.
  const Topic<slammot_Constraint> as_estimate{
      {topics::kConstraint.name, topics::kConstraint.type, Flow::kCommand, Recorded::kNo}};
  const Writer<slammot_Constraint> writer(writing, as_estimate);
  const Reader<slammot_Constraint> reader(reading, topics::kConstraint);
  ASSERT_TRUE(reader.wait_for_mismatch(kForever));
  ASSERT_TRUE(writer.wait_for_mismatch(kForever));
  ASSERT_TRUE(reader.mismatch().has_value());
  EXPECT_EQ(reader.mismatch()->policy, "durability");
  EXPECT_EQ(reader.mismatch()->text(),
            "slammot/constraint: cannot be connected with another participant's endpoint because "
            "of durability (1 so far)");
  EXPECT_EQ(writer.mismatch()->policy, "durability");
  EXPECT_EQ(reader.matched_writers(), 0U);
}

TEST(Reader, NamesTheTypeWhenItKeepsItFromAWriter) {
  const PrivateBus bus;
  const Participant writing = bus.join("writing");
  const Participant reading = bus.join("reading");
  const Topic<slammot_Odometry> other_type{
      {topics::kHeartbeat.name, topics::kOdometry.type, Flow::kHeartbeat, Recorded::kNo}};
  const Writer<slammot_Odometry> writer(writing, other_type);
  const Reader<slammot_Heartbeat> reader(reading, topics::kHeartbeat);
  ASSERT_TRUE(reader.wait_for_mismatch(kForever));
  EXPECT_EQ(reader.mismatch()->policy, "type");
}

TEST(Reader, ReportsNoMismatchWhereThereIsNone) {
  const PrivateBus bus;
  const Participant participant = bus.join();
  const Reader<slammot_Odometry> reader(participant, topics::kOdometry);
  EXPECT_FALSE(reader.mismatch().has_value());
}

}  // namespace
}  // namespace slammot::dds
