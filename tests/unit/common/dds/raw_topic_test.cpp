#include "common/dds/raw_topic.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/dds/cdr_walk.hpp"
#include "common/dds/idl_text.hpp"
#include "common/dds/raw_writer.hpp"
#include "common/dds/topic_discovery.hpp"
#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using slammot::testing::assign;
using slammot::testing::kForever;
using slammot::testing::PrivateBus;
using ::testing::HasSubstr;

RawType compiled_type(const TopicInfo& topic) {
  const auto& information = topic.type->type_information;
  const auto& mapping = topic.type->type_mapping;
  return {std::string(topic.type_name()),
          {information.data, information.data + information.sz},
          {mapping.data, mapping.data + mapping.sz}};
}

/// Whether an appendable structure is among the members, sequences aside.
bool has_appendable_part(const TypeModel& model, const NamedType& type) {
  return std::ranges::any_of(type.members, [&](const TypeMember& member) {
    const TypeUse& use =
        member.type.kind == TypeKind::kArray ? member.type.element.front() : member.type;
    const NamedType* const part = use.kind == TypeKind::kNamed ? model.find(use.name) : nullptr;
    return part != nullptr && part->kind == NamedType::Kind::kStruct &&
           (part->extensibility != Extensibility::kFinal || has_appendable_part(model, *part));
  });
}

slammot_LaserScan scan(std::vector<float>& ranges) {
  slammot_LaserScan sample{};
  assign(sample.vehicle_id, "car");
  assign(sample.scanner_id, "front");
  sample.stamp_ns = 1234;
  sample.ranges_m._buffer = ranges.data();
  sample.ranges_m._length = sample.ranges_m._maximum = static_cast<std::uint32_t>(ranges.size());
  return sample;
}

/// Participants in this process that know each other by the network only, as those of two processes
/// do: one domain for the library's network, two for its memory.
struct RawTopicOnTheBus : ::testing::Test {
  PrivateBus bus;
  Participant car = join(0);
  Participant player = join(0);  // a participant has one QoS for all topics of one name
  Participant recorder = join(1);
  Participant consumer = join(1);

  Participant join(std::uint32_t number) {
    const std::string network = "<CycloneDDS><Domain Id=\"any\"><Discovery><ExternalDomainId>" +
                                std::to_string(bus.domain_id) +
                                "</ExternalDomainId></Discovery></Domain></CycloneDDS>";
    return Participant({.domain_id = bus.domain_id + number,
                        .name = "test",
                        .config = bus.config + "," + network});
  }

  static FoundWriter find(TopicDiscovery& discovery, const std::string& topic) {
    const auto end = std::chrono::steady_clock::now() + kForever;
    while (std::chrono::steady_clock::now() < end) {
      for (FoundWriter& writer : discovery.take()) {
        if (writer.topic_name == topic) return writer;
      }
    }
    return {};
  }
};

TEST_F(RawTopicOnTheBus, EveryTypeComesBackFromItsDescription) {
  for (const TopicInfo* topic : topic_table()) {
    const RawType type = compiled_type(*topic);
    const auto raw = RawTopic::of_type(std::string(topic->name), type);
    ASSERT_TRUE(raw) << topic->name;
    EXPECT_EQ(raw->type(), type) << topic->name;
    EXPECT_EQ(raw->model().types.back().name, topic->type_name());
    EXPECT_TRUE(is_keyed(raw->model()));
  }
}

TEST_F(RawTopicOnTheBus, TypesWithAnAppendableStructureStateTheirLeastBytes) {
  for (const TopicInfo* topic : topic_table()) {
    const auto raw = RawTopic::of_type(std::string(topic->name), compiled_type(*topic));
    ASSERT_TRUE(raw) << topic->name;
    EXPECT_EQ(topic->least_bytes > 0, has_appendable_part(raw->model(), raw->model().types.back()))
        << topic->name;
  }
}

TEST_F(RawTopicOnTheBus, BytesTravelUnchangedWithTheirSourceTime) {
  Writer<slammot_LaserScan> writer(car, topics::kLaserScan);
  TopicDiscovery discovery(recorder);
  const FoundWriter found = find(discovery, "slammot/laser_scan");
  ASSERT_TRUE(found.information);
  EXPECT_EQ(found.type_name, "slammot::LaserScan");
  EXPECT_TRUE(found.qos.is_reliable);
  EXPECT_EQ(found.qos.depth, 20);
  const auto topic =
      RawTopic::resolve(recorder, found.topic_name, found.type_name, *found.information, kForever);
  ASSERT_TRUE(topic);
  EXPECT_EQ(topic->type().information, compiled_type(topics::kLaserScan).information);
  EXPECT_EQ(topic->type().mapping, compiled_type(topics::kLaserScan).mapping);
  RawReader reader(recorder, topic, found.qos);
  ASSERT_TRUE(writer.wait_for_readers(1, kForever));
  std::vector<float> ranges = {1.0F, 2.5F, 3.25F};
  ASSERT_EQ(writer.write(scan(ranges)), WriteResult::kWritten);
  ASSERT_TRUE(writer.wait_for_acknowledgements(kForever));
  std::vector<std::uint8_t> bytes;
  std::int64_t source_time_ns = 0;
  const auto keep = [&](const RawSample& sample) {
    bytes.assign(sample.cdr.begin(), sample.cdr.end());
    source_time_ns = sample.source_time_ns;
  };
  while (bytes.empty()) reader.take_each(keep);
  EXPECT_GT(source_time_ns, 0);

  RawWriter again(player, topic, found.qos);
  Reader<slammot_LaserScan> typed(consumer, topics::kLaserScan);
  ASSERT_TRUE(again.wait_for_readers(2, kForever));
  ASSERT_EQ(again.write({bytes, source_time_ns}), RawWriteResult::kWritten);
  std::size_t count = 0;
  while (count == 0) {
    count = typed.take_each([&](const slammot_LaserScan& sample) {
      EXPECT_EQ(sample.stamp_ns, 1234);
      ASSERT_EQ(sample.ranges_m._length, 3U);
      EXPECT_EQ(sample.ranges_m._buffer[2], 3.25F);
    });
  }
  const std::vector<std::uint8_t> first = bytes;
  const std::int64_t first_time_ns = std::exchange(source_time_ns, 0);
  while (source_time_ns == 0) reader.take_each(keep);
  EXPECT_EQ(bytes, first);
  EXPECT_EQ(source_time_ns, first_time_ns);
}

TEST_F(RawTopicOnTheBus, SamplesThatEndBeforeAStructureAreLeftOutAndCounted) {
  Writer<slammot_SubmapTile> whole(car, topics::kSubmapTile);
  TopicDiscovery discovery(recorder);
  const FoundWriter found = find(discovery, "slammot/submap_tile");
  RawWriter hostile(player,
                    RawTopic::of_type("slammot/submap_tile", compiled_type(topics::kSubmapTile)),
                    found.qos);
  Reader<slammot_SubmapTile> reader(consumer, topics::kSubmapTile);
  ASSERT_TRUE(hostile.wait_for_readers(1, kForever));
  ASSERT_TRUE(whole.wait_for_readers(1, kForever));
  // D_CDR2, 16 bytes: "car", submap 1, tile 0, and no header.
  const std::vector<std::uint8_t> keys_alone = {0,   9,   0,   0, 16, 0, 0, 0, 4, 0, 0, 0,
                                                'c', 'a', 'r', 0, 1,  0, 0, 0, 0, 0, 0, 0};
  ASSERT_EQ(hostile.write({keys_alone, 1}), RawWriteResult::kWritten);
  ASSERT_TRUE(hostile.wait_for_acknowledgements(kForever));
  slammot_SubmapTile tile{};
  assign(tile.vehicle_id, "car");
  tile.submap_id = 2;
  ASSERT_EQ(whole.write(tile), WriteResult::kWritten);
  ASSERT_TRUE(whole.wait_for_acknowledgements(kForever));
  std::vector<std::uint32_t> submaps;
  while (submaps.empty())
    reader.take_each([&](const slammot_SubmapTile& got) { submaps.push_back(got.submap_id); });
  EXPECT_THAT(submaps, ::testing::ElementsAre(2));
  EXPECT_EQ(reader.cut(), 1U);
  EXPECT_EQ(reader.counters().taken, 1U);
}

TEST_F(RawTopicOnTheBus, InstancesAreToldApartByTheirKeys) {
  RawWriter writer(
      player, RawTopic::of_type("slammot/constraint", compiled_type(topics::kConstraint)),
      {.is_transient_local = true, .depth = 1, .representation = DDS_DATA_REPRESENTATION_XCDR2});
  Writer<slammot_Constraint> typed(car, topics::kConstraint);
  RawReader raw(recorder,
                RawTopic::of_type("slammot/constraint", compiled_type(topics::kConstraint)),
                {.is_transient_local = true});
  ASSERT_TRUE(typed.wait_for_readers(1, kForever));
  for (std::uint32_t i = 0; i < 3; ++i) {
    slammot_Constraint sample{};
    assign(sample.vehicle_id, "car");
    sample.from_submap_id = i;
    typed.write(sample);
    typed.write(sample);
  }
  std::size_t sent = 0;
  while (sent < 6) {
    sent += raw.take_each([&](const RawSample& sample) {
      EXPECT_EQ(writer.write(sample), RawWriteResult::kWritten);
    });
  }
  Reader<slammot_Constraint> late(consumer, topics::kConstraint);
  std::set<std::uint32_t> received;
  const auto end = std::chrono::steady_clock::now() + kForever;
  while (received.size() < 3 && std::chrono::steady_clock::now() < end)
    late.take_each([&](const slammot_Constraint& c) { received.insert(c.from_submap_id); });
  EXPECT_EQ(received.size(), 3U);
}

TEST_F(RawTopicOnTheBus, BytesWithoutAKeyAreNotWritten) {
  RawWriter writer(car, RawTopic::of_type("slammot/laser_scan", compiled_type(topics::kLaserScan)),
                   {});
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp): the same ones each time
  EXPECT_EQ(writer.write({{}, 1}), RawWriteResult::kMalformed);
  for (std::size_t size = 1; size < 60; ++size) {
    std::vector<std::uint8_t> bytes(size);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() | 0x80);
    EXPECT_EQ(writer.write({bytes, 1}), RawWriteResult::kMalformed) << size;
  }
}

TEST(RawTopic, OfADamagedDescriptionIsNone) {
  const RawType whole = compiled_type(topics::kTrackedObjects);
  std::mt19937 random(2);  // NOLINT(cert-msc51-cpp): the same ones each time
  for (std::size_t size = 0; size < whole.mapping.size(); size += 97) {
    RawType cut = whole;
    cut.mapping.resize(size);
    EXPECT_FALSE(RawTopic::of_type("topic", cut)) << size;
  }
  std::size_t readable = 0;
  for (int i = 0; i < 500; ++i) {
    RawType changed = whole;
    changed.mapping[random() % changed.mapping.size()] ^=
        static_cast<std::uint8_t>(1 << (random() % 8));
    const auto topic = RawTopic::of_type("topic", changed);
    readable += topic && !idl_text(topic->model()).empty() ? 1 : 0;
  }
  EXPECT_GT(readable, 0U);
}

TEST(IdlText, IsWhatTheIdlFileSaysWithoutItsComments) {
  const auto model = model_of(compiled_type(topics::kOdometry));
  ASSERT_TRUE(model);
  EXPECT_EQ(idl_text(*model), R"(module slammot {
@final @nested struct Pose2 {
  double x_m;
  double y_m;
  double heading_rad;
};
};

module slammot {
@appendable struct Odometry {
  @key string<32> vehicle_id;
  int64 stamp_ns;
  slammot::Pose2 wheel_from_base;
};
};
)");
}

TEST(IdlText, HasSequencesArraysAndEnums) {
  const auto model = model_of(compiled_type(topics::kTrackedObjects));
  ASSERT_TRUE(model);
  const std::string text = idl_text(*model);
  EXPECT_THAT(text, HasSubstr("enum Motion {\n  MOTION_MOVING,\n  MOTION_STOPPED\n};"));
  EXPECT_THAT(text, HasSubstr("double covariance[16];"));
  EXPECT_THAT(text, HasSubstr("sequence<slammot::TrackedObject, 192> objects;"));
  EXPECT_LT(text.find("enum Motion"), text.find("struct TrackedObject "));
  EXPECT_LT(text.find("struct TrackedObject "), text.find("struct TrackedObjects "));
}

TEST(OfferedQos, ComesBackFromItsTexts) {
  OfferedQos qos{.is_reliable = false,
                 .is_transient_local = true,
                 .is_exclusive = true,
                 .ownership_strength = 7,
                 .depth = 20,
                 .lifespan_ns = 5'000'000,
                 .manual_liveliness_ns = 1'000'000'000,
                 .partitions = {"a", "b"}};
  EXPECT_EQ(offered_qos_of(texts_of(qos)), qos);
  EXPECT_EQ(offered_qos_of(texts_of(OfferedQos{})), OfferedQos{});
}

TEST(OfferedQos, TextsThatMakeNoSenseGiveDefaults) {
  EXPECT_EQ(offered_qos_of({{"qos.depth", "many"}, {"qos.lifespan_ns", "-3"}, {"other", "x"}}),
            OfferedQos{});
  EXPECT_EQ(offered_qos_of({{"qos.depth", "99999999999999999999"}}), OfferedQos{});
}

}  // namespace
}  // namespace slammot::dds
