#include "common/dds/discovery.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/dds/reader.hpp"
#include "common/dds/writer.hpp"
#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using namespace std::chrono_literals;
using slammot::testing::kForever;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Participants in this process that know each other by the network only, as those of two processes
/// do: one domain for the library's network, two for its memory.
struct DiscoveryOnTheBus : ::testing::Test {
  slammot::testing::PrivateBus bus;
  Participant other = join(0, "slammot-other");
  Participant own = join(1, "observer");
  Discovery discovery{own};

  Participant join(std::uint32_t number, const std::string& name) const {
    const std::string network = "<CycloneDDS><Domain Id=\"any\"><Discovery><ExternalDomainId>" +
                                std::to_string(bus.domain_id) +
                                "</ExternalDomainId></Discovery></Domain></CycloneDDS>";
    return Participant({bus.domain_id + number, name, bus.config + "," + network});
  }

  const RemoteEndpoint* find(std::string_view topic, bool is_writer) {
    const auto end = std::chrono::steady_clock::now() + kForever;
    while (std::chrono::steady_clock::now() < end) {
      discovery.settle(50ms, 100ms);
      for (const auto& [guid, endpoint] : discovery.endpoints()) {
        if (endpoint.topic == topic && endpoint.is_writer == is_writer) return &endpoint;
      }
    }
    return nullptr;
  }
};

TEST_F(DiscoveryOnTheBus, SeesAWriterWithItsTypeItsQosAndItsProcess) {
  const Writer<slammot_SubmapTile> writer(other, topics::kSubmapTile);
  const RemoteEndpoint* const found = find(topics::kSubmapTile.name, true);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->type, topics::kSubmapTile.type_name());
  EXPECT_THAT(found->qos.text(), ::testing::StartsWith("reliable, transient-local, keep-last 1"));
  EXPECT_EQ(discovery.peer_of(*found).name, "slammot-other");
  EXPECT_FALSE(found->type_hash.empty());
}

TEST_F(DiscoveryOnTheBus, ForgetsAReaderThatEnded) {
  {
    const Reader<slammot_Odometry> reader(other, topics::kOdometry);
    ASSERT_NE(find(topics::kOdometry.name, false), nullptr);
  }
  const auto end = std::chrono::steady_clock::now() + kForever;
  while (!discovery.endpoints().empty() && std::chrono::steady_clock::now() < end)
    discovery.settle(50ms, 100ms);
  EXPECT_TRUE(discovery.endpoints().empty());
}

TEST_F(DiscoveryOnTheBus, LeavesOutItsOwnEndpoints) {
  const Reader<slammot_Odometry> mine(own, topics::kOdometry);
  const Reader<slammot_LaserScan> others(other, topics::kLaserScan);
  ASSERT_NE(find(topics::kLaserScan.name, false), nullptr);
  EXPECT_EQ(discovery.endpoints().size(), 1U);
}

TEST(Incompatibilities, AreNoneOfEqualQos) {
  const EndpointQos qos{.is_reliable = true,
                        .durability = EndpointQos::Durability::kTransientLocal};
  EXPECT_THAT(incompatibilities(qos, qos), IsEmpty());
}

TEST(Incompatibilities, AreNoneWhereTheWriterOffersMore) {
  const EndpointQos writer{.is_reliable = true,
                           .durability = EndpointQos::Durability::kTransientLocal,
                           .liveliness = EndpointQos::Liveliness::kManualByTopic,
                           .lease_ns = 1000,
                           .deadline_ns = 1000};
  EXPECT_THAT(incompatibilities(writer, EndpointQos{.lease_ns = 2000, .deadline_ns = 2000}),
              IsEmpty());
}

TEST(Incompatibilities, AreNamedOneByOne) {
  const EndpointQos reader{.is_reliable = true,
                           .durability = EndpointQos::Durability::kTransientLocal,
                           .liveliness = EndpointQos::Liveliness::kManualByTopic,
                           .lease_ns = 1'000'000,
                           .deadline_ns = 1'000'000,
                           .is_exclusive = true,
                           .is_by_source_time = true,
                           .partitions = {"a"}};
  EXPECT_THAT(incompatibilities({}, reader),
              ::testing::ElementsAre(HasSubstr("reliability"), HasSubstr("durability"),
                                     HasSubstr("deadline"), HasSubstr("liveliness"),
                                     HasSubstr("liveliness lease"), HasSubstr("ownership"),
                                     HasSubstr("destination order"), HasSubstr("partition")));
}

TEST(Incompatibilities, TakePatternsOfPartitionsForAnyName) {
  EXPECT_THAT(incompatibilities({.partitions = {"car*"}}, {.partitions = {"car7"}}), IsEmpty());
}

}  // namespace
}  // namespace slammot::dds
